"""The arrays that a run is made in: the chain with its motion, how far it is, the
record."""

from typing import NamedTuple

import numpy as np

from precursors.model.chain import FloatArray
from precursors.solver.kernel.layout import ROWS, TERMS, WIDTH

# `motion` is one array, (rows, columns), as Numba takes long to hand on a tuple of
# arrays. Column 0 is the drive, columns 1..N are the blocks; beyond them is room for a
# group.
#
# The chain: the stiffness behind a block, mu_s w_i and mu_k w_i [N], and 1 where a
# block bears a load that counts in slip events.
COUPLING, STRENGTH, FRICTION, BEARS_LOAD = range(4)
# The state: velocities; spring forces in two doubles; the net force of the springs on
# each block; its mode.
VELOCITY, SPRING_FORCE, FORCE_REST, NET_FORCE, MODE = range(4, 9)
# What follows from the modes: SLIDES is 1 or 0 (1 for the drive), PUSH is the friction
# against the motion, HOLD is mu_s w_i where a block sticks, FELT is 1 where a block or
# a neighbour of it moves.
SLIDES, PUSH, HOLD, FELT = range(9, 13)
# A window: SIGN is that of `guess.watched`; spring forces at its start; SLIP is the way
# since then; UNDECIDED has the blocks of a group that are not proved as bits.
SIGN, FORCE_BEFORE, REST_BEFORE, SLIP, UNDECIDED = range(13, 18)
# By term, not by block: s^n / n! for the length of the window, and for the time looked
# at; room for the series of one function.
WHOLE, WEIGHT, SERIES = range(18, 21)
# The first of the rows with derivatives: see `series.expand`.
RATE = 21
# Doubles in a line of the cache.
LINE = 8


class System(NamedTuple):
    """A chain in the kernel's units: `tau` is in s, `speed` is the unit N/tau of
    velocities in m/s."""

    n_blocks: int
    tau: float
    speed: float
    drive_velocity: float


class Batch(NamedTuple):
    """Chains of equal length and their starts, a row each: see `units.parameters`; [N],
    [m], [m/s]."""

    parameters: FloatArray
    weights: FloatArray
    positions: FloatArray
    velocities: FloatArray


class End(NamedTuple):
    """Where runs end: at a time [s], after a global slip, and with an error after so
    many transitions or windows."""

    duration: float
    until_global: bool
    most: int
    most_windows: int


# Where a run is: tau [s]; time of the event's onset in two doubles [s], time since then
# and since the last transition [tau]; numbers of transitions, moving blocks, those of
# them without load, blocks whose load counts, those of them that slide, stored states,
# transitions between two of these, windows, derivatives of single blocks, searches of a
# function and steps to roots; whether all blocks whose load counts slid at once; how it
# ended; a block beyond which none slides; windows on end in which time stood still.
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

# Numbers in a row of a record: a transition's time [s], block, mode, tangential load
# [N], and the interval before it [s]. After the last of a run comes the time that is
# reached, and the interval before that.
ROW = 5


def memory_for(n_blocks: int) -> FloatArray:
    """Room for `motion`, in which no group of blocks lies across two lines of the
    cache."""
    groups = n_blocks // WIDTH + 2
    columns = LINE * -(-max(WIDTH * groups, TERMS) // LINE)
    size = (RATE + ROWS) * columns
    memory = np.zeros(size + LINE)
    block_1 = 1 + memory.ctypes.data // memory.itemsize
    first = -block_1 % LINE
    return memory[first : first + size].reshape(-1, columns)
