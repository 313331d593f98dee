"""`python -m reference`, run in tests/, writes the golden data of the reference again
(about a minute)."""

from . import hostile
from .goldens import write_goldens

write_goldens()
hostile.write()
