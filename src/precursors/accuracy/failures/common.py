"""What a failure mode gives: the numbers that show it and the curves that draw it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike

from precursors.model.chain import FloatArray

# The first five slips of theta = 0, with 30 transitions [s].
FIVE_SLIPS = 1.25


@dataclass(frozen=True)
class Number:
    """A measured number that shows a failure of a method with a setting; `exact` is
    what is right, or NaN.

    `predicted` is what the method should give, NaN where nothing is known; `theory`
    says from what that follows, if not from the method and the chain.
    """

    method: str
    setting: str
    quantity: str
    unit: str
    measured: float
    exact: float = float("nan")
    predicted: float = float("nan")
    theory: str = ""


@dataclass(frozen=True)
class Threshold:
    """A value of a method's setting from which it fails, predicted and measured:
    infinity if it never does.

    `method` is its label, `fails` what happens there, `theory` the formula that
    predicts it.
    """

    method: str
    n_blocks: int
    fails: str
    unit: str
    theory: str
    predicted: float
    measured: float


@dataclass(frozen=True)
class Failure:
    """A failure, measured: its numbers, curves (columns: curve, x, y with units) and
    thresholds."""

    numbers: tuple[Number, ...]
    curves: pd.DataFrame
    thresholds: tuple[Threshold, ...] = ()


def curves(x: str, y: str, **points: tuple[ArrayLike, ArrayLike]) -> pd.DataFrame:
    """Table of curves from (x, y) pairs of arrays by name; an underscore in a name is a
    space."""
    parts = [
        pd.DataFrame(
            {
                "curve": name.replace("_", " "),
                x: np.atleast_1d(xs),
                y: np.atleast_1d(ys),
            }
        )
        for name, (xs, ys) in points.items()
    ]
    return pd.concat(parts, ignore_index=True)


def runge_kutta_step(
    rate: Callable[[FloatArray], FloatArray], y: FloatArray, h: float
) -> FloatArray:
    """One step of Runge and Kutta's method, as `methods.rk4` makes it, under any rate
    of change."""
    k1 = rate(y)
    k2 = rate(y + 0.5 * h * k1)
    k3 = rate(y + 0.5 * h * k2)
    return y + h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + rate(y + h * k3))
