"""The arrays that a run is made in: what is known of the chain, its motion, and what is recorded of it."""

from __future__ import annotations

from itertools import accumulate
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from precursors.model.chain import FloatArray
from precursors.solver.kernel.layout import BEYOND, LEAPS, LEVELS, ROWS, WIDTH

IntArray = NDArray[np.int64]


class Columns(NamedTuple):
    """A chain in the kernel's units: spring behind each block, mu_s w_i, mu_k w_i, and r_i."""

    coupling: FloatArray
    strength: FloatArray
    friction: FloatArray
    lightness: FloatArray


class Additions(NamedTuple):
    """What joins blocks to each other and to the plane besides springs; see the package's docstring."""

    dashpot: FloatArray
    anchor: FloatArray
    grip: FloatArray
    hold: FloatArray


class Ringing(NamedTuple):
    """Room for what moves on springs: what rounding took away, and what `ringing.leap` needs."""

    lost: FloatArray
    lost_grip: FloatArray
    pivot: FloatArray
    softness: FloatArray
    creep: FloatArray
    leaps: FloatArray


class State(NamedTuple):
    """Velocities, spring forces and modes of the blocks."""

    velocity: FloatArray
    tension: FloatArray
    mode: IntArray


class Search(NamedTuple):
    """Watched functions, a slot each: Taylor series, numbers about them, and bounds of their first roots.

    `active[1 : active[0] + 1]` are the slots that may have a root in the window.
    """

    series: FloatArray
    level: FloatArray
    terms: IntArray
    stage: IntArray
    bound: FloatArray
    active: IntArray


class Motion(NamedTuple):
    """The motion within a window: Taylor rows of the velocities, and what goes with them, by columns."""

    rate: FloatArray
    mobile: FloatArray
    sense: FloatArray
    push: FloatArray
    slip: FloatArray
    origins: FloatArray
    tension_before: FloatArray
    fastest: FloatArray
    suspects: NDArray[np.uint64]
    weight: FloatArray
    spare: FloatArray
    behind: FloatArray
    ahead: FloatArray


class Window(NamedTuple):
    """What is looked at: `span` from `origin` on [tau], series of that order, and blocks first..final.

    Block `last` is the farthest that may change its mode, `end` the last column of a whole group of four. A
    value counts as zero below the relative size `doubt`.
    """

    origin: float
    span: float
    order: int
    first: int
    final: int
    last: int
    end: int
    is_long: bool
    doubt: float


class Record(NamedTuple):
    """Transitions: times [s], blocks, new modes, tangential loads [N], and the intervals between them [s]."""

    time: FloatArray
    block: IntArray
    mode: IntArray
    tangential_load: FloatArray
    intervals: FloatArray


class States(NamedTuple):
    """Stored states in the kernel's units and columns; row 0 is the start, before any transition.

    Spring forces [N], velocities [N/tau], modes, the number of transitions before, the time since [s], and
    forces of the interface springs [N]: no columns where the interface is rigid.
    """

    force: FloatArray
    velocity: FloatArray
    mode: IntArray
    after: IntArray
    offset: FloatArray
    grip: FloatArray = np.empty((0, 0))

    @classmethod
    def none(cls, n_blocks: int) -> States:
        """No states of N blocks."""
        rows = np.empty((0, width(n_blocks)))
        return cls(rows, rows, rows.astype(np.int64), np.empty(0, np.int64), np.empty(0))


class Limits(NamedTuple):
    """Where a run ends: time [s], after a global slip, full records, windows that were worked on."""

    duration: float
    until_global: bool
    room: int
    state_room: int
    budget: int


class Room(NamedTuple):
    """All that a run is made in."""

    columns: Columns
    state: State
    motion: Motion
    search: Search
    record: Record
    states: States

    @property
    def arrays(self) -> tuple[NDArray[Any], ...]:
        """The arrays one by one."""
        return (*self.columns, *self.state, *self.motion, *self.search, *self.record, *self.states)


# Where in `Room.arrays` each part but the first begins.
STATE_AT, MOTION_AT, SEARCH_AT, RECORD_AT, STATES_AT = accumulate(
    len(part._fields) for part in (Columns, State, Motion, Search, Record)
)


def width(n_blocks: int) -> int:
    """Number of columns of a chain's arrays."""
    return n_blocks + 1 + BEYOND


def new_columns(n_blocks: int) -> Columns:
    """Room for a chain."""
    return Columns(*np.zeros((4, width(n_blocks))))


def new_additions(n_blocks: int) -> Additions:
    """Room for the additions of a chain."""
    return Additions(*np.zeros((4, width(n_blocks))))


def new_state(n_blocks: int) -> State:
    """Room for the state of a chain."""
    wide = width(n_blocks)
    return State(np.zeros(wide), np.zeros(wide), np.zeros(wide, np.int64))


def new_ringing(n_blocks: int, on_springs: bool) -> Ringing:
    """Room for chains with additions; leaps are for those on interface springs only."""
    wide = width(n_blocks)
    leaps = np.zeros((LEAPS + 2, 2 * n_blocks, 2 * n_blocks) if on_springs else (0, 0, 0))
    lost, lost_grip, softness, creep = np.zeros((4, wide))
    return Ringing(lost, lost_grip, np.zeros(2 * wide), softness, creep, leaps)


def new_search(n_blocks: int) -> Search:
    """Room for the search of the next transition: two slots a block."""
    slots = 2 * width(n_blocks)
    return Search(
        series=np.zeros((slots, ROWS + 1)),
        level=np.zeros((slots, LEVELS)),
        terms=np.zeros(slots, np.int64),
        stage=np.zeros(slots, np.int64),
        bound=np.zeros(slots),
        active=np.zeros(slots + 1, np.int64),
    )


def new_motion(n_blocks: int) -> Motion:
    """Room for the motion within a window."""
    wide = width(n_blocks)
    mobile, sense, push, slip, origins, tension_before, fastest = np.zeros((7, wide))
    weight, spare, behind, ahead = np.zeros((4, ROWS + WIDTH))
    return Motion(
        rate=np.zeros((ROWS + 1, wide)),
        mobile=mobile,
        sense=sense,
        push=push,
        slip=slip,
        origins=origins,
        tension_before=tension_before,
        fastest=fastest,
        suspects=np.zeros(wide, np.uint64),
        weight=weight,
        spare=spare,
        behind=behind,
        ahead=ahead,
    )
