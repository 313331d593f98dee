"""The words that a claim may use: rows, what is taken of them, and the rules that give a verdict."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from precursors.analysis.slip_rows import first_global, up_to_first_global
from precursors.model.chain import FloatArray

if TYPE_CHECKING:
    import pandas as pd

REPRODUCED = "reproduced"
FRAGILE = "reproduced but fragile"
NOT_REPRODUCED = "not reproduced"
MISPRINT = "misprint"
NOT_TESTABLE = "not testable by the model"
VERDICTS = (REPRODUCED, FRAGILE, NOT_REPRODUCED, MISPRINT, NOT_TESTABLE)

# What a claim is about; verdicts are counted for each kind, as inputs would swell the number of results.
KINDS = {
    "input": "that the chain computed here is the one described",
    "result": "what the model or the theory gives",
    "reading": "how it is printed, or what another reading of it gives",
    "experiment": "what is said of the experiment, or of model and experiment together",
}


def _rank_correlation(values: FloatArray) -> float:
    """Kendall's tau of the values with their order: 1 where each is larger than all before it."""
    n = len(values)
    later_less_earlier = np.sign(values[np.newaxis, :] - values[:, np.newaxis])
    return float(np.triu(later_less_earlier).sum()) / (n * (n - 1) / 2) if n > 1 else np.nan


def _variation(values: FloatArray) -> float:
    """Standard deviation of the steps between values over their mean: 0 for a period."""
    steps = np.diff(values)
    return float(np.std(steps) / np.mean(steps)) if len(steps) > 1 else np.nan


# What is made of the values of a column; "count" counts rows, "slope" fits a line by least squares.
TAKES: dict[str, Callable[[FloatArray], Any]] = {
    "each": lambda values: values,
    "first": lambda values: values[0] if len(values) else np.nan,
    "last": lambda values: values[-1] if len(values) else np.nan,
    "smallest": lambda values: values.min() if len(values) else np.nan,
    "largest": lambda values: values.max() if len(values) else np.nan,
    "mean": lambda values: values.mean() if len(values) else np.nan,
    "sum": np.sum,
    "count": len,
    "rank correlation": _rank_correlation,
    "variation of steps": _variation,
}
SLOPE = "slope"


ROWS: dict[str, Callable[[pd.DataFrame], pd.DataFrame]] = {
    "all": lambda table: table,
    "up to the global slip": up_to_first_global,
    "before the global slip": lambda table: table.iloc[: first_global(table)],
}


@dataclass(frozen=True)
class Margin:
    """How exactly values are compared.

    Attributes
    ----------
    tolerance, relative : float
        Allowed difference, in the unit of the values and relative to what they are compared with.
    digits : int or None
        Digits after the point that the paper prints.
    """

    tolerance: float = 0.0
    relative: float = 0.0
    digits: int | None = None


@dataclass(frozen=True)
class Rule:
    """A way to judge.

    Attributes
    ----------
    holds : callable
        (values, what they are compared with, Margin) -> bool.
    compares : bool
        Whether the values are compared with something: `against`, `limit` or `paper` of the claim.
    otherwise : str
        The verdict where it does not hold.
    """

    holds: Callable[[FloatArray, FloatArray, Margin], Any]
    compares: bool = True
    otherwise: str = NOT_REPRODUCED


def _equal(values: FloatArray, reference: FloatArray, margin: Margin) -> Any:
    return np.all(np.abs(values - reference) <= margin.tolerance + margin.relative * np.abs(reference))


def _rounds(values: FloatArray, reference: FloatArray, margin: Margin) -> Any:
    half = 0.5 * 10.0 ** -(margin.digits or 0)
    return np.all((values >= reference - half) & (values < reference + half))


NO_RESULT = "no result"
ROUNDS = "rounds to"
RULES = {
    "equal": Rule(_equal),
    ROUNDS: Rule(_rounds),
    "above": Rule(lambda values, reference, _: np.all(values > reference)),
    "at least": Rule(lambda values, reference, _: np.all(values >= reference)),
    "below": Rule(lambda values, reference, _: np.all(values < reference)),
    "at most": Rule(lambda values, reference, _: np.all(values <= reference)),
    "increasing": Rule(lambda values, *_: len(values) > 1 and np.all(np.diff(values) > 0), compares=False),
    "decreasing": Rule(lambda values, *_: len(values) > 1 and np.all(np.diff(values) < 0), compares=False),
    "same": Rule(lambda values, _, margin: np.ptp(values) <= margin.tolerance, compares=False),
    "holds": Rule(lambda values, *_: np.all(values == 1), compares=False),
    # The values are what a formula or word gives as it is printed; they are compared with the right ones.
    "as printed": Rule(_equal, otherwise=MISPRINT),
    # The quantity is none of the model's: no table speaks of it.
    NO_RESULT: Rule(lambda *_: False, compares=False, otherwise=NOT_TESTABLE),
}
