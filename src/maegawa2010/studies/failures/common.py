"""A curve of a failure mode."""

from dataclasses import dataclass
from typing import Literal

from numpy.typing import ArrayLike


@dataclass(frozen=True)
class Curve:
    """A curve of a failure mode: its name and points.

    Its role is that of the method that fails, of the exact solution, of the theory
    (that of a failing curve has its name), or of something to compare with.
    """

    name: str
    x: ArrayLike
    y: ArrayLike
    role: Literal["failing", "exact", "theory", "reference"] = "failing"
