"""Readings of what the paper leaves open, of a slip table, and the growth of L_p."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from precursors.analysis.slips import until_global

# L_p/L from which the length of the experiment's precursors grows faster (Sect. 6.1).
KINK = 0.7
GLOBAL_SLIPS = {
    "at once": "in which all blocks slide at the same instant",
    "each": "in which every block slides at some time",
}
FRONTS = {
    "front": "farthest block that slid",
    "n_slid": "number of blocks that slid",
    "n_simultaneous": "most blocks that slid at the same instant",
}
SHORT_EVENTS = {
    "shorter": "shorter than one before it",
    "not longer": "not longer than all before it",
    "shorter than the last": "shorter than the one just before it",
}


@dataclass(frozen=True)
class Definition:
    """A reading; the default is the one that gives the paper's numbers.

    Attributes
    ----------
    global_slip : str or float
        A key of GLOBAL_SLIPS, or the drop of F_X [N] above which an event is a global
        slip.
    front : str
        The column of the slip table that is the length of an event, a key of FRONTS.
    short : str
        Which events Fig. 13 leaves out, a key of SHORT_EVENTS.
    """

    global_slip: str | float = "at once"
    front: str = "front"
    short: str = "shorter"

    def is_global(self, slips: pd.DataFrame) -> Any:
        """Which events are global slips."""
        if self.global_slip == "at once":
            return slips["is_global"]
        if self.global_slip == "each":
            return slips["n_slid"] == slips["n_blocks"]
        return slips["load_before_N"] - slips["load_after_N"] > self.global_slip

    def is_short(self, slips: pd.DataFrame) -> NDArray[np.bool_]:
        """Which events are short."""
        front = slips[self.front].to_numpy()
        farthest = np.maximum.accumulate(front)
        if self.short == "shorter":
            return front < farthest
        if self.short == "not longer":
            return np.diff(farthest, prepend=0) == 0
        return np.diff(front, prepend=0) < 0

    def read(self, slips: pd.DataFrame) -> pd.DataFrame:
        """A slip table by this reading."""
        is_global = self.is_global(slips)
        is_counted = until_global(is_global) & ~self.is_short(slips)
        return slips.assign(is_global=is_global, counted=is_counted)


def speedup(slips: Mapping[str, NDArray[Any]]) -> float:
    """Growth of L_p with F_X beyond KINK L, over that before, in the events counted, of
    the columns of a slip table.

    The first event of the whole length ends the second, and the last one before it of
    up to KINK L divides the two. NaN where one of them has no rise of L_p or F_X.
    """
    front, load, n_blocks = (
        slips[name][slips["counted"]] for name in ("front", "load_before_N", "n_blocks")
    )
    whole = np.flatnonzero(front == n_blocks)
    if not len(whole) or not slips["is_global"].any():
        return math.nan
    up_to_kink = np.flatnonzero(front[: whole[0]] <= KINK * n_blocks[0])
    three = [0, up_to_kink[-1] if len(up_to_kink) else 0, whole[0]]
    rise = np.diff(front[three])
    span = np.diff(load[three])
    if rise[0] <= 0 or span[1] <= 0:
        return math.nan
    return float(rise[1] * span[0] / (rise[0] * span[1]))
