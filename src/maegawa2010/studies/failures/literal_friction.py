"""Eq. 4 taken literally, in steps of RK4: a block that has slid never sticks again.

By Eq. 4 a block sticks only if its velocity is exactly zero, and a velocity that crosses
zero between two evaluations is never exactly zero.
"""

import math
from pathlib import Path

import numpy as np

from maegawa2010.methods.columns import (
    FORCE,
    INVERSE_MASS,
    KINETIC,
    STRENGTH,
    at_rest,
)
from maegawa2010.methods.compiled import FOLDER, OPTIONS, inner
from maegawa2010.methods.runge_kutta import STAGES, rk4_step
from maegawa2010.studies.failures.common import Curve
from precursors.model.chain import Chain
from precursors.solver.simulate import simulate
from precursors.support.compiled import entry

END = 1.0  # s
STEPS = (3e-6, 1e-6)  # s
POINTS = 66

compiled = entry(Path(__file__), FOLDER, **OPTIONS)


@inner
def as_printed(system, _state, i, net, velocity):
    """The friction law of Eqs. 4-6: velocity and acceleration of block i."""
    if velocity == 0.0:
        held = min(max(net, -system[STRENGTH, i]), system[STRENGTH, i])
        return 0.0, system[INVERSE_MASS, i] * (net - held)
    friction = math.copysign(system[KINETIC, i], velocity)
    return velocity, system[INVERSE_MASS, i] * (net - friction)


@compiled
def slide(system, state, h, n_steps):
    """Make `n_steps` steps of h [s] of the whole chain."""
    n = state.shape[1] - 2
    work = np.zeros((STAGES + 1, 2, n + 2))
    for _ in range(n_steps):
        rk4_step(as_printed, system, state, n, h, work)


def literal_friction() -> list[Curve]:
    """F_X of the exact solution, and of RK4 with Eq. 4 taken literally."""
    chain = Chain.from_slider()
    run = simulate(chain, END)
    exact_times = np.concatenate([[0.0], run.transitions["time"], [END]])
    exact = run.tangential_load(exact_times)
    curves = [Curve("exact", exact_times, exact, "exact")]
    limit = float(chain.strength[0])
    onset = limit / chain.loading_rate
    for step in STEPS:
        system, state = at_rest(chain)
        state[FORCE, 1] = limit
        load = [0.0, limit]
        n_steps = round((END - onset) / POINTS / step)
        for _ in range(POINTS):
            slide(system, state, step, n_steps)
            load.append(float(state[FORCE, 1]))
        times = onset + n_steps * step * np.arange(POINTS + 1)
        curves.append(Curve(f"dt = {step:.0e} s", [0.0, *times], load))
    return curves
