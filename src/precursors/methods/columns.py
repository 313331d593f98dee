"""The chain in columns: what every method knows of it, its forces, and its motion while nothing switches.

The state is the force T_i in the spring behind each block and the block's velocity v_i (Eqs. 2-6):

    dT_i/dt = c_i (v_{i-1} - v_i),    m dv_i/dt = T_i - T_{i+1} - mode_i mu_k w_i   where block i slides,

with c = K, k, k, ... and v_0 = V. Unlike positions, these numbers do not grow with the drive, so their
rounding does not grow either. Column 0 of every array is the drive, columns 1..N the blocks, column N + 1
the free end.

Units are SI, or those of solvers with a tolerance, which meet numbers near one: force in N, time in
tau = sqrt(m / stiffest spring), velocity in N/tau. Then 1/m and the largest c_i are 1."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path

import numpy as np
from numba import int64, njit

from precursors.model.chain import Chain, FloatArray
from precursors.model.switching import COULOMB, FORWARD_ONLY
from precursors.model.switching import KINETIC as KINETIC_LIMIT
from precursors.solver.kernel.compiled import entry

# Numba counts references to all arrays of a tuple at each call, which costs more than a step. So what is
# called in every step is inlined. Assignments to slices are loops here: Numba compiles their errors' texts.
# A function is compiled anew for a literal number, unless its variable has a type.
apart = njit(error_model="numpy", fastmath={"contract"}, locals={"first": int64})
inner = njit(error_model="numpy", fastmath={"contract"}, forceinline=True)
# Written into its only caller before that is compiled, not compiled for itself as well.
template = njit(inline="always")
# Python calls these; their code is kept until one of these files is edited, or their own.
MODULES = "columns dop853 events fixed_step karnopp leapfrog moreau_jean newmark rk4 rk4_located"
COMPILED = [f"{name}.py" for name in MODULES.split()]
outer = entry(Path(__file__).parent, COMPILED, error_model="numpy", fastmath={"contract"}, nogil=True)

# Rows of a system, which stay: the spring behind each column [N/m], 1/m, mu_s w and mu_k w [N]; the largest
# forces [N] that do not release a stuck block backward and do not turn a stopping block round.
SPRING, INVERSE_MASS, STRENGTH, KINETIC, BACKWARD, TURNING = range(6)
# Rows of a state, which change: spring force [N], velocity [m/s], mode, 1/m where a block slides, mode_i mu_k
# w_i [N]. The first two are also those of its rates, and of states that a method tries.
FORCE, VELOCITY, MODE, MOBILITY, FRICTION = range(5)

# Rule of switching: from mu_s w and mu_k w to the rows BACKWARD and TURNING. The first is ours.
SWITCHING_RULES: dict[str, Callable[[FloatArray, FloatArray], tuple[FloatArray, FloatArray]]] = {
    COULOMB: lambda strength, _kinetic: (strength, strength),
    KINETIC_LIMIT: lambda strength, kinetic: (strength, kinetic),
    FORWARD_ONLY: lambda strength, _kinetic: (np.full_like(strength, np.inf),) * 2,
}


def time_unit(chain: Chain) -> float:
    """tau [s]."""
    return math.sqrt(chain.mass / float(np.max(chain.springs)))


def at_rest(chain: Chain, rule: str = COULOMB, scaled: bool = False) -> tuple[FloatArray, FloatArray]:
    """System and state of a chain whose blocks all stick, springs at natural length; `scaled`: in tau."""
    system, state = np.zeros((6, chain.n_blocks + 2)), np.zeros((5, chain.n_blocks + 2))
    blocks = system[:, 1:-1]
    blocks[SPRING], blocks[INVERSE_MASS] = chain.springs, 1.0 / chain.mass
    blocks[STRENGTH], blocks[KINETIC] = chain.strength, chain.kinetic_friction
    blocks[BACKWARD], blocks[TURNING] = SWITCHING_RULES[rule](blocks[STRENGTH], blocks[KINETIC])
    state[VELOCITY, 0] = chain.drive_velocity
    if scaled:
        blocks[SPRING] /= np.max(chain.springs)
        blocks[INVERSE_MASS] = 1.0
        state[VELOCITY, 0] *= chain.mass / time_unit(chain)
    return system, state


def set_modes(system: FloatArray, state: FloatArray, modes: FloatArray) -> None:
    """Set the modes of all blocks, shape (N,), and what follows from them."""
    state[MODE, 1:-1] = modes
    state[MOBILITY], state[FRICTION] = abs(state[MODE]) * system[INVERSE_MASS], state[MODE] * system[KINETIC]


def sliding_forward(chain: Chain, velocities: FloatArray) -> tuple[FloatArray, FloatArray]:
    """System and state of blocks that slide forward [m/s], shape (N,), springs at natural length."""
    system, state = at_rest(chain)
    set_modes(system, state, np.ones(chain.n_blocks))
    state[VELOCITY, 1:-1] = velocities
    return system, state


# Equations of motion


@inner
def net_force(y, i):
    """Force of the springs on block i (Eqs. 2-4)."""
    return y[FORCE, i] - y[FORCE, i + 1]


@inner
def by_mode(_system, state, i, net, velocity, _parameter):
    """Velocity of block i as the springs see it, and its acceleration: friction is that of its mode."""
    return velocity, state[MOBILITY, i] * (net - state[FRICTION, i])


@inner
def rates(law, parameter, system, state, last, y, rate):
    """Rates of a state y under a law of friction (Eqs. 2-6); blocks ahead of 1..last rest."""
    behind = y[VELOCITY, 0]
    for i in range(1, last + 1):
        here, rate[VELOCITY, i] = law(system, state, i, net_force(y, i), y[VELOCITY, i], parameter)
        rate[FORCE, i] = system[SPRING, i] * (behind - here)
        behind = here
    rate[FORCE, last + 1] = system[SPRING, last + 1] * behind
    rate[VELOCITY, last + 1] = 0.0


@inner
def copy(y, last, result):
    """Copy spring forces and velocities up to the next after the last block that slides."""
    for row in range(2):
        for i in range(1, last + 2):
            result[row, i] = y[row, i]


@inner
def accelerate(state, last, h):
    """Change the velocities of blocks 1..last by h times the acceleration."""
    for i in range(1, last + 1):
        state[VELOCITY, i] += h * state[MOBILITY, i] * (net_force(state, i) - state[FRICTION, i])


@inner
def stretch(system, state, last, h):
    """Change the spring forces by what blocks 1..last move in a time h at their velocities."""
    for i in range(1, last + 1):
        state[FORCE, i] += h * system[SPRING, i] * (state[VELOCITY, i - 1] - state[VELOCITY, i])
    state[FORCE, last + 1] += h * system[SPRING, last + 1] * state[VELOCITY, last]


@inner
def solve_springs(system, state, last, weight, result, factor):
    """Solve x_i = r_i + weight / m (c_i (x_{i-1} - x_i) - c_{i+1} (x_i - x_{i+1})) for blocks 1..last.

    `result` is r and becomes x, by elimination of the tridiagonal system; x_0 is given, and x_i = r_i where
    block i sticks.
    """
    spring, mobility = system[SPRING], state[MOBILITY]
    factor[0] = 0.0
    for i in range(1, last + 1):
        behind, ahead = weight * mobility[i] * spring[i], weight * mobility[i] * spring[i + 1]
        pivot = 1.0 / (1.0 + behind + ahead - behind * factor[i - 1])
        factor[i] = ahead * pivot
        result[i] = (result[i] + behind * result[i - 1]) * pivot
    result[last + 1] = 0.0
    for i in range(last, 0, -1):
        result[i] += factor[i] * result[i + 1]


# Stick and slip (Eq. 5)


@inner
def along_mode(state, y, i):
    """Velocity of a sliding block in the direction of its mode, in a state y."""
    return state[MODE, i] * y[VELOCITY, i]


@inner
def event_function(system, state, y, i):
    """What is positive while block i keeps its mode in a state y: its velocity along it, or a margin [N]."""
    if state[MODE, i] != 0.0:
        return along_mode(state, y, i)
    net = net_force(y, i)
    return min(system[STRENGTH, i] - net, system[BACKWARD, i] + net)


@inner
def move_by(system, state, i, mode):
    """Give a block the mobility and the friction of a mode."""
    state[MOBILITY, i] = system[INVERSE_MASS, i] if mode != 0 else 0.0
    state[FRICTION, i] = mode * system[KINETIC, i]


@inner
def resting_mode(system, state, i):
    """Mode of a block that stops: by the rule of switching it sticks, or slides on along the force."""
    net = net_force(state, i)
    return int(np.sign(net)) if abs(net) > system[TURNING, i] else 0
