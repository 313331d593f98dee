"""What a way to fail is: the numbers that show it and the curves that draw it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike

from precursors.accuracy.compare import Truth, compare
from precursors.solver.run import Run


@dataclass(frozen=True)
class Number:
    """A measured number that shows a failure.

    Attributes
    ----------
    method : str
        What failed.
    knob : str
        Its setting, with unit.
    quantity, unit : str
        What was measured.
    value : float
        What the method gave.
    exact : float
        What is right: the exact solver's, or the theory's; NaN where there is no such number.
    """

    method: str
    knob: str
    quantity: str
    unit: str
    value: float
    exact: float = float("nan")


@dataclass(frozen=True)
class Failure:
    """A way to fail, measured.

    Attributes
    ----------
    numbers : tuple of Number
        At least one.
    curves : DataFrame
        Columns: the curve's name, x and y, with units in the names.
    """

    numbers: tuple[Number, ...]
    curves: pd.DataFrame


@dataclass(frozen=True)
class Way:
    """A way to fail: its name and what measures it."""

    name: str
    measure: Callable[[], Failure]


def curves(x: str, y: str, **points: tuple[ArrayLike, ArrayLike]) -> pd.DataFrame:
    """Table of curves from (x, y) pairs of arrays by name; an underscore in a name is a space."""
    parts = [
        pd.DataFrame({"curve": name.replace("_", " "), x: np.atleast_1d(xs), y: np.atleast_1d(ys)})
        for name, (xs, ys) in points.items()
    ]
    return pd.concat(parts, ignore_index=True)


def transitions_right(run: Run, exact: Run) -> int:
    """Number of transitions before the first that is not the exact run's."""
    return compare(run, Truth.of_run(exact)).transitions_right
