"""Two roots of an event function in one step, both of which are missed."""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp

from maegawa2010.methods.events import NUDGE, EventMotion
from maegawa2010.methods.scipy_events import solve_scipy
from maegawa2010.methods.stability import bisect
from maegawa2010.studies.failures.common import Curve, Failure, Threshold
from precursors.analysis.slips import find_slips
from precursors.benchmark.compare import transitions_right
from precursors.model.chain import Chain
from precursors.solver.run import Run
from precursors.solver.simulate import simulate

# At the loose tolerance DOP853 steps over two roots of a velocity; with steps of at
# most so many seconds, it does not and does.
LOOSE = 1e-7
TIGHT = 1e-10
SHORT_STEP = 1e-6
LONG_STEP = 4e-6
BISECTIONS = 4  # of the threshold, to 9 %


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
        "scipy_dop853",
        chain.n_blocks,
        fails="roots_missed",
        theory="time for which the velocity is below zero, read off the exact run",
        predicted=below_zero,
        measured=longest,
    )
    curves = [
        Curve("exact", times * motion.tau, velocity, "exact"),
        Curve("steps of DOP853", steps.t * motion.tau, steps.y[column] * to_velocity),
    ]
    return Failure("time_s", "velocity_m_per_s", curves, limit)
