"""The chain in columns: what compiled methods know of it, its forces, and its motion while nothing switches.

The state is the force T_i in the spring behind each block and the block's velocity v_i (Eqs. 2-6):

    dT_i/dt = c_i (v_{i-1} - v_i),    m dv_i/dt = T_i - T_{i+1} - mode_i mu_k w_i   where block i slides,

with c = K, k, k, ... and v_0 = V. Unlike positions, these numbers do not grow with the drive, so their
rounding does not grow either. Column 0 of every array is the drive, columns 1..N the blocks, column N + 1
the free end."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from precursors.model.chain import Chain, FloatArray
from precursors.model.switching import COULOMB, FORWARD_ONLY, KINETIC
from precursors.solver.kernel.compiled import entry

# Numba counts references to all arrays of a tuple at each call, which costs more than a step. So what is
# called in every step is inlined.
apart = njit(error_model="numpy", fastmath={"contract"})
inner = njit(error_model="numpy", fastmath={"contract"}, forceinline=True)
# Python calls these; their code is kept until one of these files is edited, or their own.
COMPILED = (
    "columns.py",
    "dop853.py",
    "events.py",
    "fixed_step.py",
    "karnopp.py",
    "leapfrog.py",
    "moreau_jean.py",
    "newmark.py",
    "rk4.py",
    "rk4_located.py",
)
outer = entry(Path(__file__).parent, COMPILED, error_model="numpy", fastmath={"contract"}, nogil=True)


class System(NamedTuple):
    """What stays: 1/m, V, and for each column the spring behind it [N/m], mu_s w and mu_k w [N].

    `backward` [N] is the largest force that does not release a stuck block backward, `turning` [N] the
    largest that does not turn a stopping block round: see `SWITCHING_RULES`.
    """

    inverse_mass: float
    drive_velocity: float
    spring: FloatArray
    strength: FloatArray
    kinetic_friction: FloatArray
    backward: FloatArray
    turning: FloatArray


# Rule of switching: from mu_s w and mu_k w to `System.backward` and `System.turning`. The first is ours.
SWITCHING_RULES: dict[str, Callable[[FloatArray, FloatArray], tuple[FloatArray, FloatArray]]] = {
    COULOMB: lambda strength, _kinetic: (strength, strength),
    KINETIC: lambda strength, kinetic: (strength, kinetic),
    FORWARD_ONLY: lambda strength, _kinetic: (np.full_like(strength, np.inf),) * 2,
}


class State(NamedTuple):
    """What changes: spring force [N], velocity [m/s], mode, 1/m where a block slides, mode_i mu_k w_i [N]."""

    spring_force: FloatArray
    velocity: FloatArray
    mode: NDArray[np.int64]
    mobility: FloatArray
    friction: FloatArray


def system_of(chain: Chain, rule: str = COULOMB) -> System:
    """Put a chain into columns, with a rule of switching."""
    friction = chain.strength, chain.kinetic_friction
    columns = chain.springs, *friction, *SWITCHING_RULES[rule](*friction)
    return System(1.0 / chain.mass, chain.drive_velocity, *(np.pad(values, 1) for values in columns))


def at_rest(system: System) -> State:
    """All blocks stick, springs at natural length."""
    n = len(system.spring)
    state = State(np.zeros(n), np.zeros(n), np.zeros(n, np.int64), np.zeros(n), np.zeros(n))
    state.velocity[0] = system.drive_velocity
    return state


def sliding_forward(system: System, velocities: FloatArray) -> State:
    """All blocks slide forward with the given velocities [m/s], shape (N,), springs at natural length."""
    state = at_rest(system)
    state.velocity[1:-1] = velocities
    state.mode[1:-1] = 1
    state.mobility[1:-1] = system.inverse_mass
    state.friction[:] = system.kinetic_friction
    return state


@inner
def by_mode(_system, state, i, net, velocity, _parameter):
    """Velocity of block i as the springs see it, and its acceleration: friction is that of its mode."""
    return velocity, state.mobility[i] * (net - state.friction[i])


@inner
def rates(law, parameter, system, state, last, spring_force, velocity, force_rate, acceleration):
    """Right-hand side (Eqs. 2-6) of blocks 1..last under a law of friction; blocks ahead of these rest."""
    behind = velocity[0]
    for i in range(1, last + 1):
        net = spring_force[i] - spring_force[i + 1]
        here, acceleration[i] = law(system, state, i, net, velocity[i], parameter)
        force_rate[i] = system.spring[i] * (behind - here)
        behind = here
    force_rate[last + 1] = system.spring[last + 1] * behind
    acceleration[last + 1] = 0.0


@inner
def accelerate(state, last, h):
    """Change the velocities of blocks 1..last by h times the acceleration (Eqs. 2-4)."""
    force, velocity, mobility, friction = state.spring_force, state.velocity, state.mobility, state.friction
    for i in range(1, last + 1):
        velocity[i] += h * mobility[i] * (force[i] - force[i + 1] - friction[i])


@inner
def stretch(system, state, last, h):
    """Change the spring forces by what blocks 1..last move in a time h at their velocities."""
    force, velocity, spring = state.spring_force, state.velocity, system.spring
    for i in range(1, last + 1):
        force[i] += h * spring[i] * (velocity[i - 1] - velocity[i])
    force[last + 1] += h * spring[last + 1] * velocity[last]


@inner
def solve_springs(system, state, last, weight, result, factor):
    """Solve x_i = r_i + weight / m (c_i (x_{i-1} - x_i) - c_{i+1} (x_i - x_{i+1})) for blocks 1..last.

    `result` is r and becomes x, by elimination of the tridiagonal system; x_0 is given, and x_i = r_i where
    block i sticks.
    """
    spring, mobility = system.spring, state.mobility
    factor[0] = 0.0
    for i in range(1, last + 1):
        behind, ahead = weight * mobility[i] * spring[i], weight * mobility[i] * spring[i + 1]
        pivot = 1.0 / (1.0 + behind + ahead - behind * factor[i - 1])
        factor[i] = ahead * pivot
        result[i] = (result[i] + behind * result[i - 1]) * pivot
    result[last + 1] = 0.0
    for i in range(last, 0, -1):
        result[i] += factor[i] * result[i + 1]


@inner
def rows(state, n):
    """Arrays of n rows to work in; row 3 begins with the drive's velocity, for a trial velocity."""
    result = np.zeros((n, state.velocity.shape[0]))
    result[3, 0] = state.velocity[0]
    return result


@inner
def mode_at_rest(net, forward, backward):
    """Mode of a block without velocity under the net force of its springs, held up to two limits."""
    if net > forward:
        return 1
    return -1 if net < -backward else 0


@inner
def resting_mode(system, state, i):
    """Mode of a block with zero velocity: by the rule of switching it sticks or follows the force."""
    net = state.spring_force[i] - state.spring_force[i + 1]
    if state.mode[i] == 0:
        return mode_at_rest(net, system.strength[i], system.backward[i])
    return mode_at_rest(net, system.turning[i], system.turning[i])
