"""Summary of a run: counts, mu_sapp and the first global slip."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from precursors.analysis.events import slip_events
from precursors.analysis.slip_rows import counted
from precursors.analysis.slips import mu_sapp
from precursors.model.checks import MOST_BLOCKS
from precursors.solver.run import Record

SUMMARY = np.dtype(
    [
        ("events_to_global_slip", "i8"),
        ("events_counted", "i8"),
        ("speedup", "f8"),
        ("mu_sapp", "f8"),
        ("load", "f8"),
        ("time", "f8"),
        ("end", "f8"),
        ("transitions", "i8"),
        ("reached", "?"),
        ("n_global", "i8"),
        ("n_all_events", "i8"),
    ]
)
SUMMARY_UNITS = {"load": "N", "time": "s", "end": "s"}
# L_p/L from which the length of the experiment's precursors grows faster (Sect. 6.1).
KINK = 0.7


def summarise(runs: Iterable[Record]) -> pd.DataFrame:
    """Counts, mu_sapp and the first global slip of each run.

    The numbers are those of `find_slips`, `find_precursors` and `apparent_friction`,
    for many runs at once.

    Returns
    -------
    DataFrame, one row per run
        Up to and including the first global slip: events_to_global_slip (all slip
        events), events_counted (those of Fig. 13), speedup (see `_speedup`), transitions; mu_sapp [1]
        (Eq. 1). Of the first global slip: time [s] and load F_X [N] at its onset, and
        its end [s]. Where reached is False there was no global slip: these
        are NaN, and the counts are those of the whole run. A global slip that the end
        of the run cuts off has end NaN. n_global and n_all_events count the global
        slips and the events of the whole run.
    """
    runs = list(runs)
    events = slip_events(runs)
    summaries = np.zeros(len(runs), SUMMARY)
    for name in ("speedup", "mu_sapp", "load", "time", "end"):
        summaries[name] = np.nan

    def number(which: NDArray[np.bool_]) -> NDArray[np.int64]:
        """Number of such events in each run."""
        return np.bincount(events["run"][which], minlength=len(runs))

    summaries["n_all_events"] = number(np.ones(len(events), bool))
    summaries["n_global"] = number(events["is_global"])
    summaries["reached"] = summaries["n_global"] > 0
    summaries["transitions"] = [len(run.transitions) for run in runs]

    # The last event that counts: the first global slip, or the last of the run.
    last_counted = np.cumsum(summaries["n_all_events"]) - 1
    global_slips = np.flatnonzero(events["is_global"])
    reached, first = np.unique(events["run"][global_slips], return_index=True)
    last_counted[reached] = global_slips[first]
    until_global = np.arange(len(events)) <= last_counted[events["run"]]
    # Fronts of later runs are raised above all earlier ones, so that the running
    # maximum begins anew.
    front = events["front"] + events["run"] * MOST_BLOCKS
    is_counted = until_global & counted(front)
    summaries["events_to_global_slip"] = number(until_global)
    summaries["events_counted"] = number(is_counted)

    slips = events[last_counted[reached]]
    chains = [runs[i].chain for i in reached]
    normal_load = np.array([chain.normal_load for chain in chains])
    n_blocks = np.array([chain.n_blocks for chain in chains])
    first_global = {
        "load": slips["load_before"],
        "mu_sapp": mu_sapp(slips["largest_load"], normal_load),
        "time": slips["onset"],
        "end": slips["end"],
        "transitions": slips["last"] + 1,
        "speedup": _speedup(events[is_counted], reached, n_blocks),
    }
    for name, values in first_global.items():
        summaries[name][reached] = values
    return pd.DataFrame(summaries)


def _speedup(
    counted: NDArray[np.void], runs: NDArray[np.int64], n_blocks: NDArray[np.int64]
) -> NDArray[np.float64]:
    """Growth of L_p with F_X beyond KINK L, over that before, in the counted events of
    some runs.

    The last event of up to KINK L divides the two, and the first of the whole length
    ends the second. NaN where one of them has no rise of L_p or F_X.
    """
    # Counted fronts never fall, so that these numbers ascend.
    front = counted["front"] + counted["run"] * MOST_BLOCKS
    start = runs * MOST_BLOCKS
    first = np.searchsorted(front, start)
    kink = np.searchsorted(front, start + KINK * n_blocks, "right") - 1
    last = np.searchsorted(front, start + n_blocks)
    three = counted[np.array([first, np.maximum(first, kink), last])]
    rise = np.diff(three["front"], axis=0)
    span = np.diff(three["load_before"], axis=0)
    before = rise[0] * span[1]
    undefined = np.full(len(runs), np.nan)
    return np.divide(rise[1] * span[0], before, out=undefined, where=before > 0)
