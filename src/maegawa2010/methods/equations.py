"""Equations of motion while nothing switches (Eqs. 2-6), and stick and slip (Eq. 5).

    dT_i/dt = c_i (v_{i-1} - v_i),
    m dv_i/dt = T_i - T_{i+1} - mode_i mu_k w_i    where block i slides,

with c = K, k, k, ... and v_0 = V, in the arrays of `columns`.
"""

from maegawa2010.methods.columns import (
    FORCE,
    FRICTION,
    INVERSE_MASS,
    KINETIC,
    MOBILITY,
    MODE,
    SPRING,
    STRENGTH,
    VELOCITY,
)
from maegawa2010.methods.compiled import inner


@inner
def net_force(y, i):
    """Force of the springs on block i (Eqs. 2-4)."""
    return y[FORCE, i] - y[FORCE, i + 1]


@inner
def by_mode(_system, state, i, net, velocity):
    """Velocity of block i as the springs see it, and its acceleration: friction is that
    of its mode."""
    return velocity, state[MOBILITY, i] * (net - state[FRICTION, i])


@inner
def rates(friction, system, state, last, y, rate):
    """Rates of a state y under a law of friction (Eqs. 2-6); blocks ahead of 1..last
    rest."""
    behind = y[VELOCITY, 0]
    for i in range(1, last + 1):
        here, rate[VELOCITY, i] = friction(
            system, state, i, net_force(y, i), y[VELOCITY, i]
        )
        rate[FORCE, i] = system[SPRING, i] * (behind - here)
        behind = here
    rate[FORCE, last + 1] = system[SPRING, last + 1] * behind
    rate[VELOCITY, last + 1] = 0.0


@inner
def copy(y, last, result):
    """Copy spring forces and velocities up to the next after the last block that
    slides."""
    for i in range(1, last + 2):
        result[FORCE, i] = y[FORCE, i]
        result[VELOCITY, i] = y[VELOCITY, i]


@inner
def accelerate(state, last, h):
    """Change the velocities of blocks 1..last by h times the acceleration."""
    for i in range(1, last + 1):
        state[VELOCITY, i] += (
            h * state[MOBILITY, i] * (net_force(state, i) - state[FRICTION, i])
        )


@inner
def stretch(system, state, last, h):
    """Change the spring forces by what blocks 1..last move in a time h at their
    velocities."""
    for i in range(1, last + 1):
        state[FORCE, i] += (
            h * system[SPRING, i] * (state[VELOCITY, i - 1] - state[VELOCITY, i])
        )
    state[FORCE, last + 1] += h * system[SPRING, last + 1] * state[VELOCITY, last]


@inner
def solve_springs(system, state, last, weight, result, factor):
    """Solve x_i = r_i + weight / m (c_i (x_{i-1} - x_i) - c_{i+1} (x_i - x_{i+1})) for
    blocks 1..last.

    `result` is r and becomes x, by elimination of the tridiagonal system; x_0 is given,
    and x_i = r_i where block i sticks.
    """
    spring = system[SPRING]
    mobility = state[MOBILITY]
    factor[0] = 0.0
    for i in range(1, last + 1):
        behind = weight * mobility[i] * spring[i]
        ahead = weight * mobility[i] * spring[i + 1]
        pivot = 1.0 / (1.0 + behind + ahead - behind * factor[i - 1])
        factor[i] = ahead * pivot
        result[i] = (result[i] + behind * result[i - 1]) * pivot
    result[last + 1] = 0.0
    for i in range(last, 0, -1):
        result[i] += factor[i] * result[i + 1]


# Stick and slip (Eq. 5)


@inner
def event_function(system, state, y, i):
    """Event function of block i, positive while it keeps its mode in a state y: its
    velocity along the mode, or its margin [N]."""
    if state[MODE, i] != 0.0:
        return state[MODE, i] * y[VELOCITY, i]
    return system[STRENGTH, i] - abs(net_force(y, i))


@inner
def move_by(system, state, i, mode):
    """Give a block the mobility and the friction of a mode."""
    state[MOBILITY, i] = system[INVERSE_MASS, i] if mode != 0 else 0.0
    state[FRICTION, i] = mode * system[KINETIC, i]
