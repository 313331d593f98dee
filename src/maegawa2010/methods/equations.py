"""Equations of motion between transitions (Eqs. 2-6), and conditions of stick and slip
(Eq. 5).

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
    """Friction law by the mode of block i: its velocity and its acceleration."""
    return velocity, state[MOBILITY, i] * (net - state[FRICTION, i])


@inner
def rates(friction, system, state, last, y, rate):
    """Rates of change of a state y under a friction law (Eqs. 2-6); blocks beyond `last`
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
    """Copy spring forces and velocities of blocks 1..last + 1."""
    for i in range(1, last + 2):
        result[FORCE, i] = y[FORCE, i]
        result[VELOCITY, i] = y[VELOCITY, i]


@inner
def accelerate(state, last, h):
    """Change the velocities of blocks 1..last by h times their accelerations."""
    for i in range(1, last + 1):
        state[VELOCITY, i] += (
            h * state[MOBILITY, i] * (net_force(state, i) - state[FRICTION, i])
        )


@inner
def stretch(system, state, last, h):
    """Change the spring forces by the motion of blocks 1..last during a time h at their
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

    `result` holds r and is replaced by x (elimination of a tridiagonal system). x_0 is
    given, and x_i = r_i if block i sticks.
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
    """Event function of block i in a state y, positive while the block keeps its mode:
    its velocity in the direction of the mode, or its margin mu_s w - |F| [N]."""
    if state[MODE, i] != 0.0:
        return state[MODE, i] * y[VELOCITY, i]
    return system[STRENGTH, i] - abs(net_force(y, i))


@inner
def move_by(system, state, i, mode):
    """Set the mobility and the friction of a block to those of a mode."""
    state[MOBILITY, i] = system[INVERSE_MASS, i] if mode != 0 else 0.0
    state[FRICTION, i] = mode * system[KINETIC, i]
