"""What a study keeps of a run: counts, mu_sapp and the first global slip."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from precursors.analysis.events import slip_events
from precursors.solver.run import Run

SUMMARY = np.dtype(
    [
        ("n_events", "i8"),
        ("events_kept", "i8"),
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

    The numbers are those of `find_slips`, `find_precursors` and `apparent_friction`, for many runs at once.

    Returns
    -------
    structured array, one row per run
        Up to and including the first global slip: n_events, events_kept (those of Fig. 13), transitions;
        mu_sapp [1] (Eq. 1) and the load F_X [N] that it stands for. Of the first global slip: time (its
        onset), end and crossing_time (from its onset until block N first slides) [s]. Where reached is False
        there was no global slip: these are NaN, and the counts are those of the whole run. n_global and
        n_all_events count the global slips and the events of the whole run.

    Notes
    -----
    A global slip that the end of the run cuts off has end NaN.
    """
    runs = list(runs)
    events = slip_events(runs)
    summaries = np.zeros(len(runs), SUMMARY)
    for name in ("mu_sapp", "load", "time", "end", "crossing_time"):
        summaries[name] = np.nan
    summaries["n_all_events"] = np.bincount(events["run"], minlength=len(runs))
    summaries["n_global"] = np.bincount(events["run"], events["is_global"], minlength=len(runs))
    summaries["reached"] = summaries["n_global"] > 0
    summaries["transitions"] = [len(run.transitions) for run in runs]

    # The last event that counts: the first global slip, or the last of the run.
    last_counted = np.cumsum(summaries["n_all_events"]) - 1
    global_slips = np.flatnonzero(events["is_global"])
    reached, first = np.unique(events["run"][global_slips], return_index=True)
    last_counted[reached] = global_slips[first]
    counted = np.arange(len(events)) <= last_counted[events["run"]]
    summaries["n_events"] = np.bincount(events["run"], counted, minlength=len(runs))
    # Fronts of later runs are raised above all earlier ones, so that the running maximum begins anew.
    front = events["front"] + events["run"] * (events["front"].max(initial=0) + 1)
    kept = counted & (front == np.maximum.accumulate(front))
    summaries["events_kept"] = np.bincount(events["run"], kept, minlength=len(runs))

    slips = events[last_counted[reached]]
    found = [_load_and_crossing(runs[i], slip) for i, slip in zip(reached, slips, strict=True)]
    load, crossing_time = np.array(found).reshape(-1, 2).T
    normal_load = np.array([runs[i].chain.normal_load for i in reached])
    first_global = {
        "load": load,
        "mu_sapp": load / normal_load,
        "time": slips["onset"],
        "end": slips["end"],
        "crossing_time": crossing_time,
        "transitions": slips["last"] + 1,
    }
    for name, values in first_global.items():
        summaries[name][reached] = values
    return summaries


def _load_and_crossing(run: Run, slip: np.void) -> tuple[float, float]:
    """Largest F_X up to the onset of a slip [N], and time from the onset until block N first slides [s]."""
    transitions = run.transitions
    until = np.searchsorted(transitions["time"], slip["onset"], side="right")
    of_slip = transitions[slip["first"] : slip["last"] + 1]
    arrival = np.argmax((of_slip["block"] == run.chain.n_blocks) & (of_slip["mode"] != 0))
    crossing_time = run.intervals[slip["first"] + 1 : slip["first"] + arrival + 1].sum()
    return transitions["tangential_load"][:until].max(), crossing_time
