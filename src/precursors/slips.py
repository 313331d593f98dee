"""Slip events, precursors, the first global slip and the apparent static friction coefficient (Eq. 1)."""

from __future__ import annotations

import numpy as np
import pandas as pd

from precursors.run import Run

COLUMNS = [
    "onset",
    "end",
    "load_before",
    "load_after",
    "front",
    "n_slid",
    "n_simultaneous",
    "is_global",
]


def find_slips(run: Run) -> pd.DataFrame:
    """Slip events of a run: maximal time intervals in which at least one block slides.

    Returns
    -------
    DataFrame
        One row per event: onset, end [s], load_before, load_after (F_X at onset and end) [N], front (farthest
        block that slid, 1..N), n_slid (blocks that slid at some time), n_simultaneous (most blocks that slid at
        the same instant), is_global (all N at the same instant). The event that the end of the run cuts off has
        end and load_after NaN.
    """
    transitions = run.transitions
    n = len(transitions)
    if n == 0:
        return _table(np.empty((0, len(COLUMNS))))
    sliding = transitions["mode"] != 0
    change = _change_of_state(transitions["block"], sliding, run.chain.n_blocks)
    number = np.cumsum(change)
    # An event ends where nothing slides, unless the next one begins at the same instant.
    rests = (number == 0) & (np.append(run.intervals[1:-1], np.inf) > 0.0)
    firsts = np.append(0, np.flatnonzero(rests[:-1]) + 1)
    lasts = np.append(firsts[1:] - 1, n - 1)
    finished = number[lasts] == 0
    block = transitions["block"]
    event = np.cumsum(np.isin(np.arange(n), firsts)) - 1
    released = np.unique(np.stack([event[sliding], block[sliding]]), axis=1)
    most = np.maximum.reduceat(number, firsts)
    return _table(
        np.column_stack(
            [
                transitions["time"][firsts],
                np.where(finished, transitions["time"][lasts], np.nan),
                transitions["tangential_load"][firsts],
                np.where(finished, transitions["tangential_load"][lasts], np.nan),
                np.maximum.reduceat(np.where(sliding, block, 0), firsts),
                np.bincount(released[0], minlength=len(firsts)),
                most,
                most == run.chain.n_blocks,
            ]
        )
    )


def find_precursors(slips: pd.DataFrame) -> pd.DataFrame:
    """Events of Fig. 13: short ones left out, up to and including the first global slip.

    An event is short if its front is strictly less than the farthest front before it; equal ones are kept.
    Without a global slip all events that are not short are returned.
    """
    until_global = slips.iloc[: first_global(slips) + 1] if slips["is_global"].any() else slips
    return until_global[until_global["front"] >= until_global["front"].cummax()]


def first_global(slips: pd.DataFrame) -> int:
    """Row number of the first global slip.

    Raises
    ------
    ValueError
        If there is none.
    """
    if not slips["is_global"].any():
        raise ValueError("the slips hold no global slip: run the chain for a longer duration")
    return int(np.argmax(slips["is_global"].to_numpy()))


def _change_of_state(block: np.ndarray, sliding: np.ndarray, n_blocks: int) -> np.ndarray:
    """+1 where a block starts to slide, -1 where it sticks, 0 where it only turns."""
    order = np.lexsort((np.arange(len(block)), block))
    before = np.zeros(len(block), dtype=bool)
    same = block[order][1:] == block[order][:-1]
    before[order[1:]] = np.where(same, sliding[order][:-1], False)
    return sliding.astype(int) - before.astype(int)


def _table(values: np.ndarray) -> pd.DataFrame:
    whole = dict.fromkeys(["front", "n_slid", "n_simultaneous"], int)
    return pd.DataFrame(values, columns=COLUMNS).astype({**whole, "is_global": bool})
