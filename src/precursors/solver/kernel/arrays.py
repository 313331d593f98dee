"""The arrays of a run in the kernel: its chain and motion, its progress, its record."""

from typing import NamedTuple

import numpy as np

from precursors.model.chain import FloatArray
from precursors.solver.kernel.layout import ROWS, TERMS, WIDTH

# `motion` is one array, (rows, columns), because Numba passes a tuple of arrays slowly.
# Column 0 is the drive, columns 1..N are the blocks, and further columns are padding.
#
# The chain: the stiffness behind a block, mu_s w_i and mu_k w_i [N], and 1 for a block
# that counts in slip events.
COUPLING, STRENGTH, FRICTION, BEARS_LOAD = range(4)
# The state: velocities, spring forces in two doubles, the net force of the springs on
# each block, and its mode.
VELOCITY, SPRING_FORCE, FORCE_REST, NET_FORCE, MODE = range(4, 9)
# These follow from the modes. SLIDES is 1 or 0 (1 for the drive), PUSH is the kinetic
# friction, HOLD is mu_s w_i if a block sticks, and FELT is 1 if a block or a neighbour
# of it moves.
SLIDES, PUSH, HOLD, FELT = range(9, 13)
# A window: SIGN is that of `guess.watched`, FORCE_BEFORE and REST_BEFORE are the spring
# forces at its start, SLIP is the displacement since then, and the bits of UNDECIDED
# are the blocks of a group without a proof.
SIGN, FORCE_BEFORE, REST_BEFORE, SLIP, UNDECIDED = range(13, 18)
# These have a column per term, not per block: s^n / n! for the length of the window,
# s^n / n! for the time of interest, and the series of one function.
WHOLE, WEIGHT, SERIES = range(18, 21)
# First row of the derivatives (see `series.expand`).
RATE = 21
# Doubles per cache line.
LINE = 8


class System(NamedTuple):
    """A chain in the kernel's units: `tau` is in s, and `speed` is the unit N/tau of
    velocities in m/s."""

    n_blocks: int
    tau: float
    speed: float
    drive_velocity: float


class Batch(NamedTuple):
    """Chains of equal length and their starts, one per row.

    `parameters` are those of `units.parameters`; the others are in N, m and m/s.
    """

    parameters: FloatArray
    weights: FloatArray
    positions: FloatArray
    velocities: FloatArray


class End(NamedTuple):
    """Where runs end: at `duration` [s], or after a global slip if `until_global`.

    Runs with `most` transitions or `most_windows` windows end with an error.
    """

    duration: float
    until_global: bool
    most: int
    most_windows: int


# Progress of a run:
# - tau [s], onset of the event in two doubles [s], and times since the onset and since
#   the last transition [tau];
# - numbers of transitions, of moving blocks, of those without load, of blocks whose
#   load counts, and of those that slide;
# - numbers of stored states, and of transitions between two of them;
# - numbers of windows, of derivatives of single blocks, of searches of a function, and
#   of steps to roots;
# - whether all blocks whose load counts slid at once, how the run ended, a block beyond
#   which none slides, and the number of consecutive windows in which time stood still.
PROGRESS = np.dtype(
    [(name, "f8") for name in ("tau", "onset", "onset_error", "elapsed", "since")]
    + [
        (name, "i8")
        for name in (
            "transitions",
            "sliding",
            "free",
            "loaded",
            "loaded_sliding",
            "stored",
            "stride",
            "windows",
            "derivatives",
            "searches",
            "root_steps",
            "all_slid",
            "status",
            "farthest",
            "at_once",
        )
    ]
)

# A row of a record has a transition's time [s], block, mode, tangential load [N] and
# the interval before it [s]. The row after the last transition of a run has the time
# reached, and the interval before it.
ROW = 5


def memory_for(n_blocks: int) -> FloatArray:
    """Allocate `motion` such that no group of blocks extends over two cache lines."""
    groups = n_blocks // WIDTH + 2
    columns = LINE * -(-max(WIDTH * groups, TERMS) // LINE)
    size = (RATE + ROWS) * columns
    memory = np.zeros(size + LINE)
    block_1 = 1 + memory.ctypes.data // memory.itemsize
    first = -block_1 % LINE
    return memory[first : first + size].reshape(-1, columns)
