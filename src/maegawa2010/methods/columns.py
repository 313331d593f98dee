"""The chain in columns: the arrays that all methods share.

The state is the force T_i in the spring behind each block and the block's velocity v_i.
Unlike positions, these numbers do not grow with the drive, so their rounding does not
grow either. Column 0 of every array is the drive, columns 1..N the blocks, column N + 1
the free end.

Units are SI, or those of solvers with a tolerance, which meet numbers near one: force
in N, time in tau = sqrt(m / stiffest spring), velocity in N/tau. Then 1/m and the
largest c_i are 1."""

import math

import numpy as np
from numpy.typing import ArrayLike

from precursors.model.chain import Chain, FloatArray

# Rows of `system`, constant during a run: the spring behind each column [N/m], 1/m,
# mu_s w and mu_k w [N].
SPRING, INVERSE_MASS, STRENGTH, KINETIC = range(4)
# Rows of a state, which change: spring force [N], velocity [m/s], mode, 1/m where a
# block slides, mode_i mu_k w_i [N]. The first two are also those of its rates, and of
# states that a method tries.
FORCE, VELOCITY, MODE, MOBILITY, FRICTION = range(5)


def time_unit(chain: Chain) -> float:
    """tau [s]."""
    return math.sqrt(chain.mass / float(chain.springs.max()))


def at_rest(chain: Chain, scaled: bool = False) -> tuple[FloatArray, FloatArray]:
    """System and state of a chain whose blocks all stick, springs at natural length;
    `scaled`: in tau."""
    system = np.zeros((4, chain.n_blocks + 2))
    state = np.zeros((5, chain.n_blocks + 2))
    blocks = system[:, 1:-1]
    blocks[SPRING] = chain.springs
    blocks[INVERSE_MASS] = 1.0 / chain.mass
    blocks[STRENGTH] = chain.strength
    blocks[KINETIC] = chain.kinetic_friction
    state[VELOCITY, 0] = chain.drive_velocity
    if scaled:
        blocks[SPRING] /= chain.springs.max()
        blocks[INVERSE_MASS] = 1.0
        state[VELOCITY, 0] *= chain.mass / time_unit(chain)
    return system, state


def set_modes(system: FloatArray, state: FloatArray, modes: ArrayLike) -> None:
    """Set the modes of all blocks, shape (N,), and what follows from them."""
    state[MODE, 1:-1] = modes
    state[MOBILITY] = abs(state[MODE]) * system[INVERSE_MASS]
    state[FRICTION] = state[MODE] * system[KINETIC]


def sliding_forward(
    chain: Chain, velocities: ArrayLike
) -> tuple[FloatArray, FloatArray]:
    """System and state of blocks that slide forward [m/s], shape (N,), springs at
    natural length.

    They count as stuck, but nothing holds and nothing releases them, so that they keep
    their motion.
    """
    system, state = at_rest(chain)
    set_modes(system, state, 1.0)
    state[MODE] = 0.0
    system[STRENGTH] = np.inf
    state[VELOCITY, 1:-1] = velocities
    return system, state
