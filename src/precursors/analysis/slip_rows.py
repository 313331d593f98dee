"""Rows of a slip table: the first global slip, and the events counted in Fig. 13."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

if TYPE_CHECKING:
    import pandas as pd

SHORT_EVENTS = {
    "shorter": "shorter than one before it",
    "not longer": "not longer than all before it",
    "shorter than the last": "shorter than the one just before it",
}


def counted(front: ArrayLike, short: str = "shorter") -> NDArray[np.bool_]:
    """Which of the events up to the first global slip Fig. 13 counts, by their fronts.

    Short events are left out; `short` is a key of SHORT_EVENTS that says which are.
    """
    front = np.asarray(front)
    farthest = np.maximum.accumulate(front)
    if short == "shorter":
        return front == farthest
    if short == "not longer":
        return np.diff(farthest, prepend=0) > 0
    if short == "shorter than the last":
        return np.diff(front, prepend=0) >= 0
    raise ValueError(
        f"short must be one of {', '.join(map(repr, SHORT_EVENTS))}, but is {short!r}"
    )


def first_global(slips: pd.DataFrame) -> int | None:
    """Row number of the first global slip by the column `is_global`; None without
    one."""
    is_global = slips["is_global"].to_numpy(bool)
    return int(is_global.argmax()) if is_global.any() else None


def up_to_first_global(slips: pd.DataFrame) -> pd.DataFrame:
    """Rows up to and including the first global slip; all without one."""
    first = first_global(slips)
    return slips if first is None else slips.iloc[: first + 1]
