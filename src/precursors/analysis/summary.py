"""The numbers of a run: events, mu_sapp (Eq. 1) and the first global slip."""

import math
from collections.abc import Iterable, Mapping
from typing import Any, NamedTuple, get_type_hints

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from precursors.analysis.events import slip_events
from precursors.analysis.slips import first_global, slip_columns
from precursors.solver.run import Record

# A slip table, as a DataFrame or not.
Columns = pd.DataFrame | Mapping[str, NDArray[Any]]


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
    transitions = np.array([len(run.transitions) for run in runs], dtype=int)
    tables = [slip_columns(slip_events(run), run.chain) for run in runs]
    return summaries(tables).assign(transitions=transitions)


def summaries(tables: Iterable[Columns]) -> pd.DataFrame:
    """A row for each slip table, as `summarise` has for each run."""
    return pd.DataFrame(np.array([summary_of(table) for table in tables], SUMMARY))


def apparent_friction(run: Record) -> float:
    """mu_sapp (Eq. 1): the largest F_X up to the first global slip over F_Z [1].

    NaN without a global slip.
    """
    return float(summarise([run])["mu_sapp"].item())


def summary_of(slips: Columns) -> Summary:
    """The numbers of a run from the columns of its `slip_table`."""
    is_global = np.asarray(slips["is_global"], bool)
    first = first_global(is_global)
    counts = Summary(
        events_to_global_slip=len(is_global) if first is None else first + 1,
        events_counted=int(np.sum(slips["counted"])),
        events_in_all=len(is_global),
        reached=first is not None,
    )
    if first is None:
        return counts
    slip = {name: np.asarray(column)[first] for name, column in slips.items()}
    return counts._replace(
        # Eq. 1. F_X is largest where block 1 begins to slide, or sticks after it slid
        # backward: dF_X/dt = K (V - v_1). So it is that of a transition, to within V.
        mu_sapp=slip["largest_load_N"] / slip["normal_load_N"],
        largest_load_N=slip["largest_load_N"],
        global_slip_s=slip["onset_s"],
        global_slip_end_s=slip["end_s"],
        global_slip_load_N=slip["load_before_N"],
    )
