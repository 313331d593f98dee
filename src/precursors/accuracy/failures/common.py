"""The numbers, curves and thresholds of a failure mode."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Literal

from numpy.typing import ArrayLike

from precursors.methods import ROWS
from precursors.model.chain import Chain, FloatArray

# The first five slips of theta = 0, with 30 transitions [s].
FIVE_SLIPS = 1.25


@dataclass(frozen=True)
class Number:
    """A measured number that shows a failure of a method with a setting.

    `quantity` is a key; `exact` is the right value, or NaN. `predicted` is the value
    that the method should give by theory, NaN where nothing is known.
    """

    method: str
    setting: str
    quantity: str
    unit: str
    measured: float
    exact: float = float("nan")
    predicted: float = float("nan")


@dataclass(frozen=True)
class Threshold:
    """A value of a method's setting from which it fails, predicted and measured.

    Both are infinite if it never fails. `method` and `fails` (what happens there) are
    keys, `label` names the method, and `theory` is the formula that predicts the value.
    """

    method: str
    label: str
    n_blocks: int
    fails: str
    unit: str
    theory: str
    predicted: float
    measured: float


def threshold(method: str, chain: Chain, *values: Any, **named: Any) -> Threshold:
    """The threshold of a method of `METHODS` on a chain."""
    return Threshold(method, ROWS[method]["label"], chain.n_blocks, *values, **named)


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
    """A failure, measured: its numbers, its curves and its thresholds.

    `x` and `y` name the quantities of the curves, with units.
    """

    numbers: tuple[Number, ...]
    x: str
    y: str
    curves: tuple[Curve, ...]
    thresholds: tuple[Threshold, ...] = ()


def runge_kutta_step(
    rate: Callable[[FloatArray], FloatArray], y: FloatArray, h: float
) -> FloatArray:
    """One step of Runge and Kutta's method, as `methods.rk4` makes it, under any rate
    of change."""
    k1 = rate(y)
    k2 = rate(y + 0.5 * h * k1)
    k3 = rate(y + 0.5 * h * k2)
    return y + h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + rate(y + h * k3))
