"""Summarise a run: number of events, mu_sapp (Eq. 1) and the first global slip."""

import math
from collections.abc import Iterable
from typing import NamedTuple, get_type_hints

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from precursors.analysis.slips import slip_rows, until_global
from precursors.solver.run import Record


class Summary(NamedTuple):
    """Numbers of a run; without a global slip, the last five are NaN."""

    events_to_global_slip: int  # with the first global slip; all if there is none
    events_counted: int  # those of Fig. 13
    events_in_all: int  # in the whole run
    reached: bool  # whether there is a global slip
    mu_sapp: float = math.nan  # Eq. 1
    largest_load_N: float = math.nan  # F_X, up to the first global slip
    global_slip_s: float = math.nan  # its onset
    global_slip_end_s: float = math.nan  # also NaN if the run ends during it
    global_slip_load_N: float = math.nan  # F_X at its onset


SUMMARY = np.dtype(list(get_type_hints(Summary).items()))


def summarise(runs: Record | Iterable[Record]) -> pd.DataFrame:
    """Return counts, mu_sapp and the first global slip of each run.

    Returns
    -------
    DataFrame, one row per run
        Counts: events_to_global_slip (all slip events up to and including the first
        global slip), events_counted (those of Fig. 13), events_in_all and transitions
        (both of the whole run). The first global slip: reached (whether there is one),
        mu_sapp [1] (Eq. 1), largest_load_N (largest F_X up to it), global_slip_s and
        global_slip_end_s (its onset and end), global_slip_load_N (F_X at its onset).
        Without a global slip, mu_sapp and the numbers after it are NaN, and the counts
        are those of the whole run. If the run ends during the global slip,
        global_slip_end_s is NaN.
    """
    runs = [runs] if isinstance(runs, Record) else list(runs)
    rows = np.array([summary_of(slip_rows(run)) for run in runs], SUMMARY)
    transitions = np.array([len(run.transitions) for run in runs], int)
    return pd.DataFrame(rows).assign(transitions=transitions)


def apparent_friction(run: Record) -> float:
    """Return mu_sapp (Eq. 1) [1]: the largest F_X up to the first global slip, over
    F_Z.

    It is NaN without a global slip.
    """
    return float(summarise([run])["mu_sapp"].item())


def summary_of(slips: pd.DataFrame | NDArray[np.void]) -> Summary:
    """Return the numbers of a run from its `slip_table` or `slip_rows`."""
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
        # Eq. 1. As dF_X/dt = K (V - v_1), F_X is largest when block 1 is released, or
        # when it sticks after sliding backward. Up to terms of order V, both are
        # transitions.
        mu_sapp=of_first("largest_load_N") / of_first("normal_load_N"),
        largest_load_N=of_first("largest_load_N"),
        global_slip_s=of_first("onset_s"),
        global_slip_end_s=of_first("end_s"),
        global_slip_load_N=of_first("load_before_N"),
    )
