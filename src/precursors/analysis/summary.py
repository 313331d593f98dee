"""What a study keeps of a run: counts, mu_sapp and the first global slip."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from precursors.analysis.events import slip_events
from precursors.analysis.slips import mu_sapp
from precursors.model.checks import MOST_BLOCKS
from precursors.solver.run import Run

SUMMARY = np.dtype(
    [
        ("events_to_global_slip", "i8"),
        ("events_counted", "i8"),
        ("mu_sapp", "f8"),
        ("load", "f8"),
        ("time", "f8"),
        ("end", "f8"),
        ("crossing_time", "f8"),
        ("transitions", "i8"),
        ("reached", "?"),
        ("n_global", "i8"),
        ("n_all_events", "i8"),
    ]
)
SUMMARY_UNITS = {"load": "N", "time": "s", "end": "s", "crossing_time": "s"}


def summarise(runs: Iterable[Run]) -> NDArray[np.void]:
    """Counts, mu_sapp and the first global slip of each run.

    The numbers are those of `find_slips`, `find_precursors` and `apparent_friction`,
    for many runs at once.

    Returns
    -------
    structured array, one row per run
        Up to and including the first global slip: events_to_global_slip (all slip
        events), events_counted (those of Fig. 13), transitions; mu_sapp [1] (Eq. 1) and
        the load F_X [N] that it stands for. Of the first global slip: time (its onset),
        end and crossing_time (from its onset until block N first slides) [s]. Where
        reached is False there was no global slip: these are NaN, and the counts are
        those of the whole run. A global slip that the end of the run cuts off has end
        NaN. n_global and n_all_events count the global slips and the events of the
        whole run.
    """
    runs = list(runs)
    events = slip_events(runs)
    summaries = np.zeros(len(runs), SUMMARY)
    for name in summaries.dtype.names or ():
        if SUMMARY[name].kind == "f":
            summaries[name] = np.nan
    summaries["n_all_events"] = np.bincount(events["run"], minlength=len(runs))
    summaries["n_global"] = np.bincount(
        events["run"], events["is_global"], minlength=len(runs)
    )
    summaries["reached"] = summaries["n_global"] > 0
    summaries["transitions"] = [len(run.transitions) for run in runs]

    # The last event that counts: the first global slip, or the last of the run.
    last_counted = np.cumsum(summaries["n_all_events"]) - 1
    global_slips = np.flatnonzero(events["is_global"])
    reached, first = np.unique(events["run"][global_slips], return_index=True)
    last_counted[reached] = global_slips[first]
    until_global = np.arange(len(events)) <= last_counted[events["run"]]
    summaries["events_to_global_slip"] = np.bincount(
        events["run"], until_global, minlength=len(runs)
    )
    # Fronts of later runs are raised above all earlier ones, so that the running
    # maximum begins anew.
    front = events["front"] + events["run"] * MOST_BLOCKS
    counted = until_global & (front == np.maximum.accumulate(front))
    summaries["events_counted"] = np.bincount(
        events["run"], counted, minlength=len(runs)
    )

    slips = events[last_counted[reached]]
    crossing_time = [
        _crossing_time(runs[i], slip) for i, slip in zip(reached, slips, strict=True)
    ]
    normal_load = np.array([run.chain.normal_load for run in runs])
    first_global = {
        "load": slips["largest_load"],
        "mu_sapp": mu_sapp(slips["largest_load"], normal_load[reached]),
        "time": slips["onset"],
        "end": slips["end"],
        "crossing_time": crossing_time,
        "transitions": slips["last"] + 1,
    }
    for name, values in first_global.items():
        summaries[name][reached] = values
    return summaries


def _crossing_time(run: Run, slip: np.void) -> float:
    """Time from the onset of a slip until block N first slides [s]."""
    of_slip = run.transitions[slip["first"] : slip["last"] + 1]
    arrival = np.argmax(
        (of_slip["block"] == run.chain.n_blocks) & (of_slip["mode"] != 0)
    )
    return float(run.intervals[slip["first"] + 1 : slip["first"] + arrival + 1].sum())
