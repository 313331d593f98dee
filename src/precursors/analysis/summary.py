"""The numbers of a run: events, mu_sapp (Eq. 1) and the first global slip, under every
reading of these words."""

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple, get_type_hints

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from precursors.analysis.events import slip_events
from precursors.analysis.slips import counted, first_global, slip_columns
from precursors.solver.run import Record

# A slip table, as a DataFrame or not.
Columns = pd.DataFrame | Mapping[str, NDArray[Any]]
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


@dataclass(frozen=True)
class Definition:
    """A reading of what the paper leaves open; the default is the one that gives its
    numbers.

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

    @property
    def global_slip_text(self) -> str:
        """Which event is a global slip, in words."""
        if isinstance(self.global_slip, str):
            return GLOBAL_SLIPS[self.global_slip]
        return f"in which F_X drops by more than {self.global_slip:g} N"

    def is_global(self, slips: Columns) -> NDArray[np.bool_]:
        """Which events are global slips."""
        if self.global_slip == "at once":
            return np.asarray(slips["is_global"], bool)
        if self.global_slip == "each":
            return np.equal(slips["n_slid"], slips["n_blocks"])
        drop = np.subtract(slips["load_before_N"], slips["load_after_N"])
        return np.asarray(drop > self.global_slip)


OURS = Definition()


class Summary(NamedTuple):
    """The numbers of a run; those of the first global slip are NaN without one."""

    events_to_global_slip: int  # up to and including the first; all without one
    events_counted: int  # those of Fig. 13
    events_in_all: int  # of the whole run
    n_global: int  # global slips of the whole run
    reached: bool  # whether there is a global slip
    mu_sapp: float = math.nan  # Eq. 1
    largest_load_N: float = math.nan  # F_X, up to the first global slip
    global_slip_s: float = math.nan  # its onset
    global_slip_end_s: float = math.nan  # NaN, too, if the end of the run cuts it off
    global_slip_load_N: float = math.nan  # F_X at its onset
    speedup: float = math.nan  # see `speedup`


SUMMARY = np.dtype(list(get_type_hints(Summary).items()))


def summarise(runs: Iterable[Record]) -> pd.DataFrame:
    """Counts, mu_sapp and the first global slip of each run.

    Returns
    -------
    DataFrame, one row per run
        events_to_global_slip (all slip events up to and including the first global
        slip), events_counted (those of Fig. 13), events_in_all, n_global and
        transitions (all of the run), reached (whether there is a global slip); mu_sapp
        [1] (Eq. 1), largest_load_N (F_X up to the first global slip); of that slip
        global_slip_s and global_slip_end_s, and global_slip_load_N (F_X at its onset);
        speedup [1] (see `speedup`). Without a global slip mu_sapp and all after it are
        NaN, and the counts are those of the whole run. A global slip that the end of
        the run cuts off has global_slip_end_s NaN.
    """
    runs = list(runs)
    rows = [summary_of(slip_columns(slip_events(run), run.chain)) for run in runs]
    transitions = np.array([len(run.transitions) for run in runs], dtype=int)
    return pd.DataFrame(np.array(rows, SUMMARY)).assign(transitions=transitions)


def apparent_friction(run: Record) -> float:
    """mu_sapp (Eq. 1): the largest F_X up to the first global slip over F_Z [1].

    NaN without a global slip.
    """
    return float(summarise([run])["mu_sapp"].item())


def summary_of(slips: Columns, definition: Definition = OURS) -> Summary:
    """The numbers of a run from the columns of its `slip_table`, by a definition."""
    front = np.asarray(slips[definition.front])
    is_global = definition.is_global(slips)
    is_counted = counted(front, is_global, definition.short)
    first = first_global(is_global)
    counts = Summary(
        events_to_global_slip=len(front) if first is None else first + 1,
        events_counted=int(is_counted.sum()),
        events_in_all=len(front),
        n_global=int(is_global.sum()),
        reached=first is not None,
    )
    if first is None:
        return counts
    slip = {name: np.asarray(column)[first] for name, column in slips.items()}
    loads = np.asarray(slips["load_before_N"])
    return counts._replace(
        # Eq. 1. F_X is largest where block 1 begins to slide, or sticks after it slid
        # backward: dF_X/dt = K (V - v_1). So it is that of a transition, to within V.
        mu_sapp=slip["largest_load_N"] / slip["normal_load_N"],
        largest_load_N=slip["largest_load_N"],
        global_slip_s=slip["onset_s"],
        global_slip_end_s=slip["end_s"],
        global_slip_load_N=slip["load_before_N"],
        speedup=speedup(front[is_counted], loads[is_counted], slip["n_blocks"]),
    )


def speedup(front: NDArray[Any], load: NDArray[Any], n_blocks: int) -> float:
    """Growth of L_p with F_X beyond KINK L, over that before, in the events counted.

    The first event of the whole length ends the second, and the last one before it of
    up to KINK L divides the two. NaN where one of them has no rise of L_p or F_X.
    """
    whole = np.flatnonzero(front == n_blocks)
    if not len(whole):
        return math.nan
    up_to_kink = np.flatnonzero(front[: whole[0]] <= KINK * n_blocks)
    three = [0, up_to_kink[-1] if len(up_to_kink) else 0, whole[0]]
    rise = np.diff(front[three])
    span = np.diff(load[three])
    if rise[0] <= 0 or span[1] <= 0:
        return math.nan
    return float(rise[1] * span[0] / (rise[0] * span[1]))
