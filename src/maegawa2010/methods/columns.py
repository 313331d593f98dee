"""The arrays that all methods share, with a column for each block.

The state is the force T_i in the spring behind each block and the block's velocity v_i.
Unlike positions, these do not grow with the drive, so their rounding errors do not grow
either. In every array column 0 is the drive, columns 1..N are the blocks, and column
N + 1 is the free end.

Units are SI, or scaled for solvers with a tolerance: force in N, time in tau = sqrt(m /
stiffest spring), velocity in N/tau. Then 1/m and the largest spring stiffness c_i are 1.
"""

import math

import numpy as np
from numpy.typing import ArrayLike

from precursors.model.chain import Chain, FloatArray

# Rows of `system`, constant during a run: stiffness of the spring behind each block
# [N/m], 1/m, mu_s w and mu_k w [N].
SPRING, INVERSE_MASS, STRENGTH, KINETIC = range(4)
# Rows of a state: spring force [N], velocity [m/s], mode (-1, 0, 1), 1/m if the block
# slides or else 0, mode_i mu_k w_i [N]. Rates of a state and trial states have the first
# two rows only.
FORCE, VELOCITY, MODE, MOBILITY, FRICTION = range(5)


def time_unit(chain: Chain) -> float:
    """The unit of time tau [s]."""
    return math.sqrt(chain.mass / float(chain.springs.max()))


def at_rest(chain: Chain, scaled: bool = False) -> tuple[FloatArray, FloatArray]:
    """System and state of a chain whose blocks all stick, with springs of natural length;
    in SI units, or scaled ones."""
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
    """Set the modes of all blocks, shape (N,), and the rows that depend on them."""
    state[MODE, 1:-1] = modes
    state[MOBILITY] = abs(state[MODE]) * system[INVERSE_MASS]
    state[FRICTION] = state[MODE] * system[KINETIC]


def sliding_forward(
    chain: Chain, velocities: ArrayLike
) -> tuple[FloatArray, FloatArray]:
    """System and state of blocks that slide forward with given velocities [m/s], shape
    (N,), and springs of natural length.

    The mode of the blocks is that of stick, with infinite strength, so that no event
    function changes sign. Their mobility is that of slip, so that they slide for ever.
    """
    system, state = at_rest(chain)
    set_modes(system, state, 1.0)
    state[MODE] = 0.0
    system[STRENGTH] = np.inf
    state[VELOCITY, 1:-1] = velocities
    return system, state
