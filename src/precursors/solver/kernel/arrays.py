"""The arrays that a run is made in: the chain, its motion, the search of the next transition, the record."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numba.extending import register_jitable

from precursors.model.chain import FloatArray
from precursors.solver.kernel.compiled import inner
from precursors.solver.kernel.layout import BEYOND, LEVELS, ROWS, WIDTH
from precursors.solver.kernel.pointers import pointer, shifted, table, whole_numbers
from precursors.solver.record import IntArray

# In compiled code a vector is a pointer to a number for each column, and a table has rows of such vectors.
Vector = Any
Table = Any

# Vectors with a column for each block, and with a row for each term of a series.
BY_COLUMN, BY_TERM = 18, 4
# Doubles in a line of the cache.
LINE = 8


class System(NamedTuple):
    """A chain in the kernel's units.

    `tau` is in s, `speed` is the unit N/tau of velocities in m/s. Columns are the stiffness behind a block
    and its friction, mu_s w_i and mu_k w_i [N].
    """

    n_blocks: int
    tau: float
    speed: float
    drive_velocity: float
    coupling: FloatArray
    strength: FloatArray
    friction: FloatArray


class Motion(NamedTuple):
    """The state and the motion within a window.

    `rate` has the derivatives of the velocities, row 0 the velocities themselves. `velocity` is the state at
    the start and at the end. `spring_force` is carried in two doubles, the second in `force_rest`. `slides`
    is 1 or 0, `sense` the mode as a float, `push` the friction against the motion. `slip` is the way of each
    block since the window began, `force_before` and `rest_before` the spring forces then, `origins` the time
    about which its series is, `fastest` a bound of its speed. `suspects` has blocks that may stop as bits.
    `weight` has the terms s^n / n! for the length of the window. The others are room to work in.
    """

    velocity: Vector
    spring_force: Vector
    force_rest: Vector
    mode: Vector
    slides: Vector
    sense: Vector
    push: Vector
    slip: Vector
    origins: Vector
    force_before: Vector
    rest_before: Vector
    fastest: Vector
    suspects: Vector
    kept_force: Vector
    kept_rest: Vector
    weight: Vector
    spare: Vector
    behind: Vector
    ahead: Vector
    rate: Table


class Search(NamedTuple):
    """Watched functions, a slot each: Taylor series, numbers about them, and bounds of their first roots.

    `active[1 : active[0] + 1]` are the slots that may have a root in the window.
    """

    series: Table
    level: Table
    bound: Vector
    terms: Vector
    stage: Vector
    active: Vector


class Window(NamedTuple):
    """What is looked at: blocks first..final, from `origin` to `limit` [tau].

    Block `last` is the farthest that may change its mode, `end` the last column of a whole group of four. A
    value counts as zero below the relative size `roundings`.
    """

    origin: float
    span: float
    limit: float
    first: int
    final: int
    last: int
    end: int
    is_long: bool
    roundings: float


class Batch(NamedTuple):
    """Chains of equal length and their starts, a row each: see `units.parameters`; [N], [m], [m/s]."""

    parameters: FloatArray
    weights: FloatArray
    positions: FloatArray
    velocities: FloatArray


class Limits(NamedTuple):
    """Where a run ends or pauses.

    It ends at `duration` [s], after a global slip, or when one slip has lasted `longest_slip` [s]. It pauses
    when it has so many transitions, states, or windows in this call. A state is stored after every `stride`
    transitions or so. With `goes_on`, the run is one that was paused.
    """

    duration: float
    until_global: bool
    longest_slip: float
    transitions: int
    states: int
    windows: int
    stride: int
    goes_on: bool


class Progress(NamedTuple):
    """Where each run is: the places of its numbers are in `layout`."""

    tau: FloatArray
    clock: FloatArray
    counts: IntArray


class Record(NamedTuple):
    """Transitions: times [s], blocks, new modes, tangential loads [N], and the intervals between them [s]."""

    time: FloatArray
    block: IntArray
    mode: IntArray
    tangential_load: FloatArray
    intervals: FloatArray


def memory_for(n_blocks: int) -> FloatArray:
    """Memory that `divide` divides, in which no group of four blocks lies across two lines of the cache."""
    wide = n_columns(n_blocks)
    by_slot = 2 * wide * (ROWS + 1 + LEVELS + 4) + 1
    memory = np.zeros((BY_COLUMN + ROWS + 1) * wide + 1 + BY_TERM * (ROWS + WIDTH) + by_slot + LINE)
    block_1 = 1 + memory.ctypes.data // memory.itemsize
    return memory[-block_1 % LINE :]


@register_jitable
def n_columns(n_blocks):
    """Columns of a row: the drive, the blocks and what is beyond them, in whole groups of four."""
    return WIDTH * ((n_blocks + BEYOND + WIDTH) // WIDTH)


@inner
def divide(memory, n_blocks):
    """Divide memory into the vectors of a system (coupling, strength, friction), a motion and a search."""
    wide, slots, long = n_columns(n_blocks), 2 * n_columns(n_blocks), ROWS + WIDTH
    start = pointer(memory)
    rates = shifted(start, BY_COLUMN * wide)
    by_term = shifted(rates, (ROWS + 1) * wide + 1)
    series = shifted(by_term, BY_TERM * long)
    levels = shifted(series, slots * (ROWS + 1))
    by_slot = shifted(levels, slots * LEVELS)
    motion = Motion(
        shifted(start, 3 * wide),
        shifted(start, 4 * wide),
        shifted(start, 5 * wide),
        whole_numbers(shifted(start, 6 * wide)),
        shifted(start, 7 * wide),
        shifted(start, 8 * wide),
        shifted(start, 9 * wide),
        shifted(start, 10 * wide),
        shifted(start, 11 * wide),
        shifted(start, 12 * wide),
        shifted(start, 13 * wide),
        shifted(start, 14 * wide),
        whole_numbers(shifted(start, 15 * wide)),
        shifted(start, 16 * wide),
        shifted(start, 17 * wide),
        by_term,
        shifted(by_term, long),
        shifted(by_term, 2 * long),
        shifted(by_term, 3 * long),
        table(rates, wide),
    )
    search = Search(
        table(series, ROWS + 1),
        table(levels, LEVELS),
        by_slot,
        whole_numbers(shifted(by_slot, slots)),
        whole_numbers(shifted(by_slot, 2 * slots)),
        whole_numbers(shifted(by_slot, 3 * slots)),
    )
    return (start, shifted(start, wide), shifted(start, 2 * wide)), motion, search
