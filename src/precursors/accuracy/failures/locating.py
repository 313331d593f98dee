"""Transitions that are located wrongly: two roots in one step, a restart on a root,
merged transitions."""

from __future__ import annotations

import math
from functools import cache, partial
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp

from precursors.accuracy.attempt import attempt
from precursors.accuracy.compare import transitions_right
from precursors.accuracy.failures.common import Curve, Failure, Number, Threshold
from precursors.analysis.slips import find_slips
from precursors.methods import ROWS
from precursors.methods.dop853 import solve_dop853
from precursors.methods.events import NUDGE, EventMotion
from precursors.methods.scipy_events import solve_scipy
from precursors.methods.stability import bisect
from precursors.model.chain import Chain, FloatArray
from precursors.solver.run import Record, Run
from precursors.solver.simulate import simulate

METHOD = "DOP853 with events"
MERGING = "DOP853, transitions merged"
# Keys of what fails: two roots of a velocity are missed, two of three transitions lose
# their order.
ROOTS_MISSED = "roots_missed"
ORDER_LOST = "order_lost"
# At the loose tolerance DOP853 steps over two roots of a velocity; with steps of at
# most so many seconds, it does not and does.
LOOSE = 1e-7
TIGHT = 1e-10
SHORT_STEP = 1e-6
LONG_STEP = 4e-6
# Times [s] within which transitions are made at once; the first changes no sequence,
# the second does.
WINDOWS = (1e-7, 3e-7, 1e-6)
# Of the thresholds of both, to 9 % and 7 %.
BISECTIONS = 4
RESTART_END = 1.0  # s
SMALLEST = math.nextafter(0.0, 1.0)


def solve_merging(
    chain: Chain, duration: float, window: float, until: str | None = None
) -> Record:
    """Run a chain whose transitions are made at once where they lie closer than a
    window [s]."""
    return solve_dop853(chain, duration, TIGHT, until, window).run


def motion_after(run: Run, number: int) -> EventMotion:
    """The motion of an exact run from its transition of this number (from 1) on."""
    chain = run.chain
    motion = EventMotion(chain, run.duration, None)
    modes = np.zeros(chain.n_blocks)
    done = run.transitions[:number]
    modes[done["block"] - 1] = done["mode"]  # the last one of each block
    time, block, mode, _ = run.transitions[number - 1].tolist()
    velocities = run.at([time])[1][0] * chain.mass / motion.tau
    velocities[block - 1] = mode * NUDGE
    motion.put(modes, run.spring_forces([time])[0], velocities)
    return motion


def missed_roots() -> Failure:
    """DOP853 steps over two roots of a velocity: a block's stop is not seen."""
    chain = Chain.from_slider()
    exact = simulate(chain, 10.0, "global slip")
    n = len(exact.transitions)

    wrong = transitions_right(solve_scipy(chain, 10.0, LOOSE, "global slip").run, exact)
    ends = find_slips(exact)["end"].to_numpy()
    end_of_slip = float(ends[ends > exact.transitions["time"][wrong]][0])

    def misses(max_step: float) -> bool:
        run = solve_scipy(chain, end_of_slip, LOOSE, max_step=max_step).run
        return transitions_right(run, exact) <= wrong

    longest = bisect(misses, SHORT_STEP, LONG_STEP, BISECTIONS)
    # The motion up to three times as long as the true one, from the last right
    # transition on.
    column = chain.n_blocks + int(exact.transitions["block"][wrong]) - 1
    motion = motion_after(exact, wrong)
    span = 3.0 * float(exact.intervals[wrong]) / motion.tau
    integrate: Any = partial(solve_ivp, motion.rates, (0.0, span), motion.y, "DOP853")
    path = integrate(rtol=TIGHT, atol=TIGHT, dense_output=True).sol
    steps = integrate(rtol=LOOSE, atol=LOOSE)
    times = np.linspace(0.0, span, 301)
    to_velocity = motion.tau / chain.mass
    velocity = path(times)[column] * to_velocity
    negative = np.flatnonzero(velocity[1:] < 0.0) + 1
    below_zero = float(np.ptp(times[negative]) * motion.tau)

    # A step that is shorter than the time below zero ends in it or does not begin
    # before it.
    limit = Threshold(
        method="scipy_dop853",
        label=ROWS["scipy_dop853"]["label"],
        n_blocks=chain.n_blocks,
        fails=ROOTS_MISSED,
        unit="s",
        theory="time for which the velocity is below zero, read off the exact run",
        predicted=below_zero,
        measured=longest,
    )
    return Failure(
        (Number(METHOD, f"rtol = {LOOSE:.0e}", "transitions_right", "1", wrong, n),),
        x="time_s",
        y="velocity_m_per_s",
        curves=(
            Curve("exact", times * motion.tau, velocity, "exact"),
            Curve(
                "steps of DOP853", steps.t * motion.tau, steps.y[column] * to_velocity
            ),
        ),
        thresholds=(limit,),
    )


def restart_on_root() -> Failure:
    """A restart exactly on a root: brentq returns it again, and time stands still."""
    chain = Chain.from_slider()
    exact = simulate(chain, RESTART_END).transitions["time"]

    def times(start: float) -> FloatArray:
        """Times of the transitions [s], where a block starts with a velocity
        [N/tau]."""
        run = attempt(
            solve_scipy, chain, RESTART_END, 1e-9, nudge=start, direction=0.0
        ).run
        return run.transitions["time"]

    found = times(0.0)
    same = int((found == found[0]).sum())
    # At the start the event function is zero, or it is not: no other velocity matters.
    smallest = min(
        start for start in (0.0, SMALLEST) if len(times(start)) == len(exact)
    )
    number = partial(Number, METHOD)
    so_far = [*range(len(exact) + 1), len(exact)]
    return Failure(
        (
            number("start from v = 0", "transitions_at_once", "1", same, 1),
            number("v > 0", "smallest_start", "N/tau", smallest, predicted=SMALLEST),
        ),
        x="time_s",
        y="transitions",
        curves=(
            Curve("exact", np.hstack([0.0, exact, RESTART_END]), so_far, "exact"),
            Curve("restart", np.append(0.0, found), np.arange(len(found) + 1)),
        ),
    )


def merged_transitions() -> Failure:
    """Transitions that lie closer than a step are made at once."""
    chain = Chain.from_slider()
    exact = simulate(chain, 10.0, "global slip")
    n = len(exact.transitions)

    @cache
    def right(window: float) -> int:
        return transitions_right(
            solve_merging(chain, 10.0, window, "global slip"), exact
        )

    longest = bisect(lambda window: right(window) < n, *WINDOWS[:2], BISECTIONS)
    # Of three transitions, the last two are merged where both lie within a window after
    # the first.
    intervals = exact.intervals[:-1]
    three = float((intervals[:-1] + intervals[1:]).min())
    number = partial(Number, MERGING, f"within {WINDOWS[1]:.0e} s")
    limit = Threshold(
        method="dop853_merging",
        label=MERGING,
        n_blocks=chain.n_blocks,
        fails=ORDER_LOST,
        unit="s",
        theory="shortest time with three transitions, read off the exact run",
        predicted=three,
        measured=longest,
    )
    merged = int((intervals < WINDOWS[1]).sum())
    return Failure(
        (
            number("transitions_merged", "1", merged, 0),
            number("transitions_right", "1", right(WINDOWS[1]), n),
        ),
        x="window_s",
        y="transitions_right",
        curves=(
            Curve("exact", WINDOWS[::2], (n, n), "exact"),
            Curve("merged", WINDOWS, [right(window) for window in WINDOWS]),
        ),
        thresholds=(limit,),
    )
