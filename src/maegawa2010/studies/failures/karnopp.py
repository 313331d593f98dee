"""Friction as a function of the velocity, in the steps of RK4: Karnopp's dead zone, and
Eq. 4 as printed.

Karnopp: a block slower than a small velocity dv counts as resting. It does not stretch
the springs, and its friction balances their force up to mu_s w; outside, friction is
mu_k w against the velocity (D. Karnopp, J. Dyn. Syst. Meas. Control 107, 1985,
100-103). Eq. 4 taken literally is the same with dv = 0: a velocity that crosses zero
between two evaluations is never exactly zero, so a block that has once slid never
sticks again.
"""

import math
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from maegawa2010.methods.columns import (
    FORCE,
    INVERSE_MASS,
    KINETIC,
    STRENGTH,
    VELOCITY,
    at_rest,
)
from maegawa2010.methods.compiled import FOLDER, OPTIONS, inner
from maegawa2010.methods.runge_kutta import STAGES, rk4_step
from precursors.model.chain import Chain
from precursors.support.compiled import entry

compiled = entry(Path(__file__), FOLDER, **OPTIONS)
DEAD_ZONE = 4  # a further row of the system [m/s]


def safe_width(chain: Chain, step: float) -> float:
    """Dead zone dv [m/s] that no block can jump over in a step on its way to rest.

    Where the springs' force is within mu_s w, a sliding block slows down by at most
    (mu_s + mu_k) w h / m a step, and the zone is 2 dv wide.
    """
    slowdown = (chain.strength + chain.kinetic_friction).max() / chain.mass
    return 0.5 * step * float(slowdown)


def release_delay(chain: Chain, dead_zone: float) -> float:
    """Time [s] for which block 1, alone at its limit, creeps in the dead zone: m dv = K
    V t^2 / 2."""
    return math.sqrt(2.0 * chain.mass * dead_zone / chain.loading_rate)


@inner
def by_velocity(system, _state, i, net, velocity):
    """The law of friction with the dead zone; at dv = 0 it is Eqs. 4-6 as printed."""
    if abs(velocity) <= system[DEAD_ZONE, i]:
        held = min(max(net, -system[STRENGTH, i]), system[STRENGTH, i])
        return 0.0, system[INVERSE_MASS, i] * (net - held)
    friction = math.copysign(system[KINETIC, i], velocity)
    return velocity, system[INVERSE_MASS, i] * (net - friction)


@compiled
def slide(system, state, h, n_steps):
    """Make n steps of the whole chain."""
    n = state.shape[1] - 2
    work = np.zeros((STAGES + 1, 2, n + 2))
    for _ in range(n_steps):
        rk4_step(by_velocity, system, state, n, h, work)


def from_limit(
    chain: Chain, dead_zone: float, step: float, n_steps: int = 1
) -> Iterator[tuple[float, float]]:
    """F_X [N] and the velocity of block 1 [m/s] after every n steps [s] from the
    instant at which it has reached its limit, without end."""
    system, state = at_rest(chain)
    system = np.vstack([system, np.full_like(system[:1], dead_zone)])
    state[FORCE, 1] = chain.strength[0]
    while True:
        slide(system, state, step, n_steps)
        yield float(state[FORCE, 1]), float(state[VELOCITY, 1])
