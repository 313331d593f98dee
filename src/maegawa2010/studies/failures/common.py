"""The curves and thresholds of a failure mode."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from numpy.typing import ArrayLike

# The first five slips of theta = 0, with 30 transitions [s].
FIVE_SLIPS = 1.25


@dataclass(frozen=True)
class Threshold:
    """A step [s] from which a method fails, predicted and measured.

    Both are infinite if it never fails. `method` and `fails` (what happens there) are
    keys, and `theory` is the formula that predicts the step.
    """

    method: str
    n_blocks: int
    fails: str
    theory: str
    predicted: float
    measured: float


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


@dataclass(frozen=True)
class Failure:
    """A failure, measured: its curves and its thresholds.

    `x` and `y` name the quantities of the curves, with units.
    """

    x: str
    y: str
    curves: list[Curve]
    threshold: Threshold | None = None
