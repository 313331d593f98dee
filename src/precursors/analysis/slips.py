"""Slip events, precursors, the first global slip and mu_sapp (Eq. 1), under any reading of these words."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from itertools import product

import numpy as np
import pandas as pd

from precursors.analysis.peak_load import largest_load
from precursors.analysis.slip_rows import first_global, up_to_first_global
from precursors.solver.run import Run

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


SHORT_EVENTS = {
    "shorter": "shorter than one before it",
    "not longer": "not longer than all before it",
    "shorter than the last": "shorter than the one just before it",
}


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


def find_precursors(slips: pd.DataFrame, short: str = "shorter") -> pd.DataFrame:
    """Events of Fig. 13: short ones left out, up to and including the first global slip.

    An event is short if its front is strictly less than the farthest front before it; equal ones are kept.
    `short` may name another reading of SHORT_EVENTS. Without a global slip all events that are not short are
    returned.

    Raises
    ------
    ValueError
        If `short` is no key of SHORT_EVENTS.
    """
    until_global = up_to_first_global(slips)
    front = until_global["front"]
    if short == "shorter than the last":
        return until_global[front >= front.shift(fill_value=0)]
    farthest_before = front.cummax().shift(fill_value=0)
    if short == "not longer":
        return until_global[front > farthest_before]
    if short == "shorter":
        return until_global[front >= farthest_before]
    raise ValueError(f"short = {short!r}: allowed are {', '.join(map(repr, SHORT_EVENTS))}")


GLOBAL_SLIPS = {
    "at once": "in which all blocks slide at the same instant",
    "each": "in which every block slides at some time",
}
FRONTS = {
    "front": "farthest block that slid",
    "n_slid": "number of blocks that slid",
    "n_simultaneous": "most blocks that slid at the same instant",
}


@dataclass(frozen=True)
class Definition:
    """A reading of what the paper leaves open; the default is the one that gives its numbers.

    Attributes
    ----------
    global_slip : str or float
        A key of GLOBAL_SLIPS, or the drop of F_X [N] above which an event is a global slip.
    front : str
        The column of the slip table that is the length of an event, a key of FRONTS.
    short : str
        Which events Fig. 13 leaves out, a key of SHORT_EVENTS.
    largest : bool
        Whether mu_sapp (Eq. 1) is the largest load up to the first global slip, or that at its onset.

    Raises
    ------
    ValueError
        If one of them is none of these.
    """

    global_slip: str | float = "at once"
    front: str = "front"
    short: str = "shorter"
    largest: bool = True

    def __post_init__(self) -> None:
        if isinstance(self.global_slip, str) and self.global_slip not in GLOBAL_SLIPS:
            allowed = " and ".join(map(repr, GLOBAL_SLIPS))
            raise ValueError(
                f"global_slip = {self.global_slip!r}: allowed are {allowed}, or a drop of the load [N]"
            )
        if self.front not in FRONTS:
            raise ValueError(f"front = {self.front!r}: allowed are {', '.join(map(repr, FRONTS))}")
        if self.short not in SHORT_EVENTS:
            raise ValueError(f"short = {self.short!r}: allowed are {', '.join(map(repr, SHORT_EVENTS))}")

    @property
    def text(self) -> str:
        """What mu_sapp is, as a sentence."""
        load = "largest F_X up to" if self.largest else "F_X at the onset of"
        return f"{load} the first event {self.global_slip_text}"

    @property
    def global_slip_text(self) -> str:
        """What makes an event a global slip."""
        if isinstance(self.global_slip, str):
            return GLOBAL_SLIPS[self.global_slip]
        return f"in which F_X drops by more than {self.global_slip:g} N"

    def read(self, slips: pd.DataFrame, n_blocks: int) -> pd.DataFrame:
        """The slips of a chain of N blocks with `front` and `is_global` as this reading has them."""
        if self.global_slip == "at once":
            is_global = slips["n_simultaneous"] == n_blocks
        elif self.global_slip == "each":
            is_global = slips["n_slid"] == n_blocks
        else:
            is_global = slips["load_before"] - slips["load_after"] > self.global_slip
        return slips.assign(front=slips[self.front], is_global=is_global)


# The readings of mu_sapp (Eq. 1). The first is the one that gives the paper's numbers.
DEFINITIONS = tuple(
    Definition(global_slip, largest=largest) for global_slip in GLOBAL_SLIPS for largest in (True, False)
)


def every_definition(load_drops: Iterable[float]) -> Iterator[Definition]:
    """All readings of global slip, short event and front; `load_drops` [N] are those of a global slip."""
    global_slips: list[str | float] = [*GLOBAL_SLIPS, *load_drops]
    for global_slip, short, front in product(global_slips, SHORT_EVENTS, FRONTS):
        yield Definition(global_slip, front, short)


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
        Number of the event that begins then, that it lies in, or that is the last before it, from 1; 0
        where there is none.
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

    Parameters
    ----------
    run : Run
        The run; with stored states if its interface is elastic, see `largest_load`.
    slips : DataFrame
        Its slip events, see `find_slips`.
    definition : Definition
        What the words mean.
    """
    slips = definition.read(slips, run.chain.n_blocks)
    first = first_global(slips)
    if first is None:
        return None
    time, load = slips["onset"].iloc[first], slips["load_before"].iloc[first]
    if definition.largest:
        time, load = largest_load(run, slips, time)
    return ApparentFriction(
        mu_sapp=float(load) / run.chain.normal_load,
        load=float(load),
        time=float(time),
        event=int(np.searchsorted(slips["onset"], time, side="right")),
        events_kept=len(find_precursors(slips, definition.short)),
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
