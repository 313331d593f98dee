"""What a study keeps of a run: counts, mu_sapp and the first global slip, straight from the transitions.

The same numbers as `find_slips`, `find_precursors` and `apparent_friction` give under the definitions that
lead to the paper's numbers, in microseconds instead of milliseconds; it takes longer on an elastic interface,
where F_X is largest between transitions. All compiled code is in this one file, because a compile cache does
not see an edit in an imported file.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from numba import njit
from numpy.typing import NDArray

from precursors.solver.run import TRANSITION, Run

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

    Returns
    -------
    structured array, one row per run
        Up to and including the first global slip: n_events, events_kept (those of Fig. 13), transitions;
        mu_sapp [1] (Eq. 1) and the load F_X [N] that it stands for. Of the first global slip: time (its
        onset), end and crossing_time (from its onset until block N first slides) [s]. Where reached is False
        no global slip was met: these are NaN, and the counts are those of the whole run. n_global and
        n_all_events count the global slips and the events of the whole run.

    Notes
    -----
    "Global slip" and mu_sapp are meant as in `slips.DEFINITIONS[0]`. A global slip that the end of the run
    cuts off has end NaN.
    """
    return np.array([_summary(run) for run in runs], dtype=SUMMARY)


def _summary(run: Run) -> tuple[float, ...]:
    columns = {name: np.ascontiguousarray(run.transitions[name]) for name in TRANSITION.names or ()}
    found: tuple[float, ...] = _summarise_transitions(
        columns["time"],
        columns["block"],
        columns["mode"],
        columns["tangential_load"],
        run.intervals,
        run.chain.n_blocks,
        run.chain.normal_load,
    )
    if run.chain.interface_stiffness:
        return _with_largest_load(run, found)
    return found


def _with_largest_load(run: Run, found: tuple[float, ...]) -> tuple[float, ...]:
    """A summary with mu_sapp and its load as `apparent_friction` has them on an elastic interface."""
    from precursors.analysis.slips import apparent_friction, find_slips  # pandas takes longer than many runs

    friction = apparent_friction(run, find_slips(run))
    if friction is None:
        return found
    fields = dict(zip(SUMMARY.names or (), found, strict=True))
    return tuple({**fields, "mu_sapp": friction.mu_sapp, "load": friction.load}.values())


@njit(cache=True, nogil=True, error_model="numpy")
def _summarise_transitions(time, block, mode, load, intervals, n_blocks, normal_load):
    """Fields of `SUMMARY`, from one pass through the transitions."""
    n = len(time)
    slides = np.zeros(n_blocks + 1, np.bool_)
    sliding, most_sliding, front, farthest = 0, 0, 0, 0
    onset, since_onset, arrival = 0, 0.0, np.nan
    events, kept, n_global = 0, 0, 0
    first, last, first_events, first_kept, crossing = -1, n - 1, 0, 0, np.nan
    for i in range(n):
        # An event goes on where nothing slides for no time at all.
        if i == 0 or (sliding == 0 and intervals[i] > 0.0):
            onset, since_onset, arrival, most_sliding, front = i, 0.0, np.nan, 0, 0
        else:
            since_onset += intervals[i]
        now = mode[i] != 0
        sliding += int(now) - int(slides[block[i]])
        slides[block[i]] = now
        most_sliding = max(most_sliding, sliding)
        if now:
            front = max(front, block[i])
            if block[i] == n_blocks and np.isnan(arrival):
                arrival = since_onset
        if i + 1 < n and (sliding > 0 or intervals[i + 1] == 0.0):
            continue
        events += 1
        if front >= farthest:
            farthest = front
            kept += 1
        if most_sliding == n_blocks:
            n_global += 1
            if first < 0:
                first, last, first_events, first_kept, crossing = onset, i, events, kept, arrival
    if first < 0:
        return events, kept, np.nan, np.nan, np.nan, np.nan, np.nan, n, False, 0, events
    peak = load[first]
    for i in range(n):
        if time[i] > time[first]:
            break
        peak = max(peak, load[i])
    end = np.nan if last == n - 1 and sliding > 0 else time[last]
    first_slip = (first_events, first_kept, peak / normal_load, peak, time[first], end, crossing)
    return first_slip + (last + 1, True, n_global, events)  # noqa: RUF005 (Numba unpacks no tuple here)
