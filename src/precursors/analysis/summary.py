"""What a study keeps of a run: counts, mu_sapp and the first global slip."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from precursors.analysis.events import slip_events
from precursors.analysis.slips import mu_sapp
from precursors.solver.run import Run

SUMMARY = np.dtype(
    [
        ("n_events", "i8"),
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
        ("n_alone", "i8"),
        ("n_events_each", "i8"),
        ("mu_sapp_each", "f8"),
        ("sliding_each", "i8"),
        ("pulse_blocks", "f8"),
        ("pulse_speed", "f8"),
        ("pulse_mu", "f8"),
        ("pulse_time", "f8"),
    ]
)
SUMMARY_UNITS = {
    "load": "N",
    "time": "s",
    "end": "s",
    "crossing_time": "s",
    "pulse_speed": "m_per_s",
    "pulse_time": "s",
}
# A travelling pulse is measured over so many transitions of each block, some five times there and back.
PULSE_TRANSITIONS = 20


def summarise(runs: Iterable[Run]) -> NDArray[np.void]:
    """Counts, mu_sapp and the first global slip of each run.

    The numbers are those of `find_slips`, `find_precursors` and `apparent_friction`, for many runs at once.

    Returns
    -------
    structured array, one row per run
        Up to and including the first global slip: n_events, events_counted (those of Fig. 13), transitions;
        mu_sapp [1] (Eq. 1) and the load F_X [N] that it stands for. Of the first global slip: time (its
        onset), end and crossing_time (from its onset until block N first slides) [s]. Where reached is False
        there was no global slip: these are NaN, and the counts are those of the whole run. n_global and
        n_all_events count the global slips and the events of the whole run, n_alone the events up to the
        first global slip in which one block slid alone. n_events_each and mu_sapp_each are n_events and
        mu_sapp if every block must slide at some time of a global slip, not all at once; sliding_each is the
        most blocks that slid at once in this event (0 without one). A run that ends in an event, without a
        global slip, has pulse_blocks, the mean number of blocks that slide, pulse_mu and pulse_speed (see
        `pulse`), and pulse_time, for how long the event has lasted [s].

    Notes
    -----
    A global slip that the end of the run cuts off has end NaN.
    """
    runs = list(runs)
    events = slip_events(runs)
    summaries = np.zeros(len(runs), SUMMARY)
    for name in summaries.dtype.names or ():
        if SUMMARY[name].kind == "f":
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
    until_global = np.arange(len(events)) <= last_counted[events["run"]]
    summaries["n_events"] = np.bincount(events["run"], until_global, minlength=len(runs))
    alone = until_global & (events["n_slid"] == 1)
    summaries["n_alone"] = np.bincount(events["run"], alone, minlength=len(runs))
    # Fronts of later runs are raised above all earlier ones, so that the running maximum begins anew.
    front = events["front"] + events["run"] * (events["front"].max(initial=0) + 1)
    counted = until_global & (front == np.maximum.accumulate(front))
    summaries["events_counted"] = np.bincount(events["run"], counted, minlength=len(runs))

    slips = events[last_counted[reached]]
    crossing_time = [_crossing_time(runs[i], slip) for i, slip in zip(reached, slips, strict=True)]
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

    n_blocks = np.array([run.chain.n_blocks for run in runs], dtype=int)
    every_block = np.flatnonzero(events["n_slid"] == n_blocks[events["run"]])
    reached, first = np.unique(events["run"][every_block], return_index=True)
    summaries["n_events_each"] = summaries["n_all_events"]
    summaries["n_events_each"][reached] -= (
        np.cumsum(summaries["n_all_events"])[reached] - 1 - every_block[first]
    )
    slips = events[every_block[first]]
    summaries["mu_sapp_each"][reached] = mu_sapp(slips["largest_load"], normal_load[reached])
    summaries["sliding_each"][reached] = slips["n_simultaneous"]
    last = np.cumsum(summaries["n_all_events"]) - 1
    for i in np.flatnonzero(~summaries["reached"] & (summaries["n_all_events"] > 0)):
        if np.isnan(events["end"][last[i]]):
            for name, value in zip(("pulse_blocks", "pulse_speed", "pulse_mu"), pulse(runs[i]), strict=True):
                summaries[name][i] = value
            summaries["pulse_time"][i] = runs[i].duration - events["onset"][last[i]]
    return summaries


def pulse(run: Run) -> tuple[float, float, float]:
    """Mean number of blocks that slide at the end of a run, their speed along the chain [m/s], and F_X/F_Z.

    Each release carries the pulse on by the distance L/N of two blocks, so that its speed is L/N times the
    releases per second. If there are several pulses it is the sum of their speeds.
    """
    chain, n = run.chain, run.chain.n_blocks
    modes = run.transitions["mode"]
    start = max(0, len(modes) - PULSE_TRANSITIONS * n)
    # Every transition but a change of direction starts or stops one block.
    of_block = np.argsort(run.transitions["block"], kind="stable")
    before = np.zeros(len(modes), dtype=bool)
    same = np.diff(run.transitions["block"][of_block]) == 0
    before[of_block[1:]] = same & (modes[of_block][:-1] != 0)
    change = (modes != 0).astype(int) - before
    sliding, time = np.cumsum(change)[start:], run.intervals[start + 1 :]
    if not time.sum() > 0:
        return np.nan, np.nan, np.nan
    releases = np.count_nonzero(change[start:] > 0)
    speed = releases * chain.length / n / time.sum()
    mu = run.transitions["tangential_load"][start:].mean() / chain.normal_load
    return float(np.average(sliding, weights=time)), float(speed), float(mu)


def _crossing_time(run: Run, slip: np.void) -> float:
    """Time from the onset of a slip until block N first slides [s]."""
    of_slip = run.transitions[slip["first"] : slip["last"] + 1]
    arrival = np.argmax((of_slip["block"] == run.chain.n_blocks) & (of_slip["mode"] != 0))
    return float(run.intervals[slip["first"] + 1 : slip["first"] + arrival + 1].sum())
