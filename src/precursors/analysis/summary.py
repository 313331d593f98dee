"""The numbers of a run: events, mu_sapp (Eq. 1) and the first global slip."""

import math
from collections.abc import Iterable
from typing import NamedTuple, get_type_hints

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from precursors.analysis.slips import slip_events, until_global
from precursors.solver.run import Record


class Summary(NamedTuple):
    """The numbers of a run; those of the first global slip are NaN without one."""

    events_to_global_slip: int  # up to and including the first; all without one
    events_counted: int  # those of Fig. 13
    events_in_all: int  # of the whole run
    reached: bool  # whether there is a global slip
    mu_sapp: float = math.nan  # Eq. 1
    largest_load_N: float = math.nan  # F_X, up to the first global slip
    global_slip_s: float = math.nan  # its onset
    global_slip_end_s: float = math.nan  # NaN, too, if the end of the run cuts it off
    global_slip_load_N: float = math.nan  # F_X at its onset


SUMMARY = np.dtype(list(get_type_hints(Summary).items()))


def summarise(runs: Record | Iterable[Record]) -> pd.DataFrame:
    """Counts, mu_sapp and the first global slip of each run, or of one.

    Returns
    -------
    DataFrame, one row per run
        events_to_global_slip (all slip events up to and including the first global
        slip), events_counted (those of Fig. 13), events_in_all and transitions (all of
        the run), reached (whether there is a global slip); mu_sapp
        [1] (Eq. 1), largest_load_N (F_X up to the first global slip); of that slip
        global_slip_s and global_slip_end_s, and global_slip_load_N (F_X at its onset);
        without a global slip mu_sapp and all after it are NaN, and the counts are those
        of the whole run. A global slip that the end of the run cuts off has
        global_slip_end_s NaN.
    """
    runs = [runs] if isinstance(runs, Record) else list(runs)
    rows = np.array([summary_of(slip_events(run)) for run in runs], SUMMARY)
    transitions = np.array([len(run.transitions) for run in runs], int)
    return pd.DataFrame(rows).assign(transitions=transitions)


def apparent_friction(run: Record) -> float:
    """mu_sapp (Eq. 1): the largest F_X up to the first global slip over F_Z [1].

    NaN without a global slip.
    """
    return float(summarise([run])["mu_sapp"].item())


def summary_of(slips: pd.DataFrame | NDArray[np.void]) -> Summary:
    """The numbers of a run from its `slip_table` or `slip_events`."""
    counts = Summary(
        events_to_global_slip=int(until_global(slips["is_global"]).sum()),
        events_counted=int(slips["counted"].sum()),
        events_in_all=len(slips),
        reached=bool(slips["is_global"].any()),
    )
    if not counts.reached:
        return counts

    def of_first(column: str) -> float:
        return float(np.asarray(slips[column])[counts.events_to_global_slip - 1])

    return counts._replace(
        # Eq. 1. F_X is largest where block 1 begins to slide, or sticks after it slid
        # backward: dF_X/dt = K (V - v_1). So it is that of a transition, to within V.
        mu_sapp=of_first("largest_load_N") / of_first("normal_load_N"),
        largest_load_N=of_first("largest_load_N"),
        global_slip_s=of_first("onset_s"),
        global_slip_end_s=of_first("end_s"),
        global_slip_load_N=of_first("load_before_N"),
    )
