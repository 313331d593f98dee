"""Slip events, precursors, the first global slip and the apparent static friction coefficient (Eq. 1)."""

from __future__ import annotations

from dataclasses import dataclass

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
        One row per event: onset, end [s], load_before, load_after (F_X at onset and end) [N], front
        (farthest block that slid, 1..N), n_slid (blocks that slid at some time), n_simultaneous (most
        blocks that slid at the same instant), is_global (all N at the same instant). The event that the
        end of the run cuts off has end and load_after NaN.
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


@dataclass(frozen=True)
class Definition:
    """A reading of mu_sapp (Eq. 1), which the paper leaves open.

    Attributes
    ----------
    text : str
        The reading as a sentence.
    at_once : bool
        Whether a global slip wants all blocks to slide at the same instant, or each at some time of it.
    largest : bool
        Whether the load is the largest up to the first global slip, or that at its onset.
    """

    text: str
    at_once: bool
    largest: bool


# The first is the reading that gives the paper's numbers.
DEFINITIONS = (
    Definition("largest F_X up to the first event in which all blocks slide at the same instant", True, True),
    Definition(
        "F_X at the onset of the first event in which all blocks slide at the same instant", True, False
    ),
    Definition("largest F_X up to the first event in which every block slides at some time", False, True),
    Definition("F_X at the onset of the first event in which every block slides at some time", False, False),
)


@dataclass(frozen=True)
class ApparentFriction:
    """mu_sapp and the event that sets it.

    Attributes
    ----------
    mu_sapp : float
        F_X / F_Z [1].
    load : float
        F_X [N].
    time : float
        When F_X had this value [s].
    event : int
        Number of the event that begins then, or that it lies in, from 1.
    events_kept : int
        Events of Fig. 13 up to and including the first global slip of this definition.
    """

    mu_sapp: float
    load: float
    time: float
    event: int
    events_kept: int


def apparent_friction(
    run: Run, slips: pd.DataFrame, definition: Definition = DEFINITIONS[0]
) -> ApparentFriction | None:
    """Apparent static friction coefficient F_Xmax / F_Z of a run (Eq. 1); None without a global slip.

    F_X is largest where the drive is as fast as block 1, which is a transition to within V: the largest of
    the transitions' loads is taken.
    """
    if not definition.at_once:
        slips = slips.assign(is_global=slips["n_slid"] == run.chain.n_blocks)
    if not slips["is_global"].any():
        return None
    onset = float(slips["onset"].iloc[first_global(slips)])
    up_to = run.transitions[run.transitions["time"] <= onset]
    peak = up_to[np.argmax(up_to["tangential_load"])] if definition.largest else up_to[-1]
    return ApparentFriction(
        mu_sapp=float(peak["tangential_load"]) / run.chain.normal_load,
        load=float(peak["tangential_load"]),
        time=float(peak["time"]),
        event=int(np.searchsorted(slips["onset"], peak["time"], side="right")),
        events_kept=len(find_precursors(slips)),
    )


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
