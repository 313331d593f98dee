"""The arrays that a run is made in: the chain, its motion, how far it is, the
record."""

from typing import Any, NamedTuple

import numpy as np
from numba import from_dtype
from numba.extending import register_jitable

from precursors.model.chain import FloatArray
from precursors.solver.kernel.decorators import inner
from precursors.solver.kernel.layout import ROWS, TERMS, WIDTH
from precursors.solver.kernel.pointers import (
    EIGHT,
    cast_to,
    numbers,
    shifted,
    whole_numbers,
)

# In compiled code a vector is a pointer to a number for each column.
Vector = Any

# Vectors with a column for each block, and with a row for each term of a series.
BY_COLUMN = 14
BY_TERM = 3
# Doubles in a line of the cache.
LINE = 8


class System(NamedTuple):
    """A chain in the kernel's units.

    `tau` is in s, `speed` is the unit N/tau of velocities in m/s. Columns are the
    stiffness behind a block and its friction, mu_s w_i and mu_k w_i [N].
    """

    n_blocks: int
    tau: float
    speed: float
    drive_velocity: float
    coupling: Vector
    strength: Vector
    friction: Vector


class MotionArrays(NamedTuple):
    """The state, and the motion within a window from it.

    State: `velocity`, `spring_force` in two doubles (the second in `force_rest`), the
    net force of the springs on each block, and `mode`. It follows from the modes:
    `slides` is 1 or 0 (1 for the drive), `push` is the friction against the motion,
    `hold` is mu_s w_i where a block sticks, `felt` is 1 where a block or a neighbour of
    it moves. Window: `rate` has the derivatives, `wide` columns in a row (see
    `expand`), `sign` is that of `watched`, `force_before` and `rest_before` are the
    spring forces at its start, `slip` is the way since then; `whole` has the terms s^n
    / n! for its length, `weight` those for the time looked at; `undecided` has the
    blocks that are not proved as bits; `series` is room for one function.
    """

    velocity: Vector
    spring_force: Vector
    force_rest: Vector
    net_force: Vector
    mode: Vector
    slides: Vector
    push: Vector
    hold: Vector
    felt: Vector
    sign: Vector
    force_before: Vector
    rest_before: Vector
    slip: Vector
    undecided: Vector
    whole: Vector
    weight: Vector
    series: Vector
    rate: Vector
    wide: int


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
# them without load, stored states, transitions between two of these, windows, derivatives of single blocks,
# searches of a function and steps to roots; whether all blocks slid at once; how it
# ended; a block beyond which none slides; windows on end in which time stood still.
PROGRESS = np.dtype(
    [(name, "f8") for name in ("tau", "onset", "onset_error", "elapsed", "since")]
    + [
        (name, "i8")
        for name in (
            "transitions",
            "sliding",
            "free",
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
progress_at = cast_to(from_dtype(PROGRESS))
# Numba takes long to recognise an array of records, so that it is given their words.
WORDS = PROGRESS.itemsize // EIGHT

# Numbers in a row of a record: a transition's time [s], block, mode, tangential load
# [N], and the interval before it [s]. After the last of a run comes the time that is
# reached, and the interval before that.
ROW = 5


def memory_for(n_blocks: int) -> FloatArray:
    """Memory for `vectors_in`, in which no group of blocks lies across two lines of the
    cache."""
    memory = np.zeros(
        (3 + BY_COLUMN + ROWS) * n_columns(n_blocks) + BY_TERM * TERMS + LINE
    )
    block_1 = 1 + memory.ctypes.data // memory.itemsize
    return memory[-block_1 % LINE :]


@register_jitable
def n_columns(n_blocks):
    """Columns of a row: the drive, the blocks and what is beyond them, in whole
    groups."""
    return WIDTH * (n_blocks // WIDTH + 2)


@inner
def vectors_in(memory, n_blocks):
    """The vectors of a system (coupling, strength, friction) and a motion in memory."""
    wide = n_columns(n_blocks)
    start = numbers(memory.ctypes.data)
    terms = (3 + BY_COLUMN + ROWS) * wide

    def at(k):
        return shifted(start, k * wide)

    return (start, at(1), at(2)), MotionArrays(
        velocity=at(3),
        spring_force=at(4),
        force_rest=at(5),
        net_force=at(6),
        mode=whole_numbers(memory.ctypes.data + 7 * EIGHT * wide),
        slides=at(8),
        push=at(9),
        hold=at(10),
        felt=at(11),
        sign=at(12),
        force_before=at(13),
        rest_before=at(14),
        slip=at(15),
        undecided=whole_numbers(memory.ctypes.data + 16 * EIGHT * wide),
        whole=shifted(start, terms),
        weight=shifted(start, terms + TERMS),
        series=shifted(start, terms + 2 * TERMS),
        rate=at(3 + BY_COLUMN),
        wide=wide,
    )


@inner
def row(n, motion):
    """Row n of the derivatives."""
    return shifted(motion.rate, n * motion.wide)
