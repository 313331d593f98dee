"""An event function with two roots in one step, both of which a solver misses."""

from functools import partial
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp

from maegawa2010.methods.events import NUDGE, EventMotion
from maegawa2010.methods.scipy_events import solve_scipy
from maegawa2010.studies.failures.common import Curve
from precursors.analysis.agreement import transitions_right
from precursors.model.chain import Chain
from precursors.solver.run import Run
from precursors.solver.simulate import simulate

# A relative tolerance so loose that DOP853 steps over two roots of a velocity.
LOOSE = 1e-7
TIGHT = 1e-10


def motion_after(run: Run, number: int) -> EventMotion:
    """The motion of an exact run after its transition of this number (counted from 1)."""
    chain = run.chain
    motion = EventMotion(chain, run.duration, None)
    modes = np.zeros(chain.n_blocks)
    done = run.transitions[:number]
    modes[done["block"] - 1] = done["mode"]  # the last mode of each block
    time, block, mode, _ = run.transitions[number - 1].tolist()
    velocities = run.at([time])[1][0] * chain.mass / motion.tau
    velocities[block - 1] = mode * NUDGE
    motion.put(modes, run.spring_forces([time])[0], velocities)
    return motion


def missed_roots() -> list[Curve]:
    """DOP853 steps over two roots of a velocity, and a block does not stop."""
    chain = Chain.from_slider()
    exact = simulate(chain, 10.0, "global slip")
    wrong = transitions_right(solve_scipy(chain, 10.0, LOOSE, "global slip").run, exact)
    # Integrate from the last right transition for three times as long as the motion
    # really lasts.
    column = chain.n_blocks + int(exact.transitions["block"][wrong]) - 1
    motion = motion_after(exact, wrong)
    span = 3.0 * float(exact.intervals[wrong]) / motion.tau
    integrate: Any = partial(solve_ivp, motion.rates, (0.0, span), motion.y, "DOP853")
    path = integrate(rtol=TIGHT, atol=TIGHT, dense_output=True).sol
    steps = integrate(rtol=LOOSE, atol=LOOSE)
    times = np.linspace(0.0, span, 301)
    to_velocity = motion.tau / chain.mass
    return [
        Curve("exact", times * motion.tau, path(times)[column] * to_velocity, "exact"),
        Curve("steps of DOP853", steps.t * motion.tau, steps.y[column] * to_velocity),
    ]
