"""`python -m reference`, run in tests/, writes the golden data of the reference again (about a minute)."""

from .extended_goldens import write_extended_goldens
from .goldens import write_goldens

write_goldens()
write_extended_goldens()
