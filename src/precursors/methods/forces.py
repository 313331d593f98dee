"""Forces of the chain and what the compiled fixed-step methods share: state, switching, waiting, recording.

The state is the force T_i in the spring behind each block and the block's velocity v_i:

    dT_i/dt = c_i (v_{i-1} - v_i),    m dv_i/dt = T_i - T_{i+1} - mode_i mu_k w_i   where block i slides,

with c = K, k, k, ... and v_0 = V. That is Eqs. 2-6 in other variables: each of these methods gives the same
numbers as in positions, without the rounding of positions that grow with the drive. Column 0 of every array
is the drive, columns 1..N the blocks, column N + 1 the free end.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from precursors.model.chain import Chain, FloatArray, require_plain
from precursors.solver.compile_cache import kept, stamp

FINISHED, GLOBAL_SLIP, PAUSED, DIVERGED, MOVING = range(5)

# `clock` [s]: time of the event's onset, time since then, that of the last transition (also since the onset),
# and the waiting since the last transition that came before the onset.
ONSET, ELAPSED, NOTED, CARRIED = range(4)
CLOCK_SIZE = 4
# `count`: transitions, sliding blocks, whether all slid at once, farthest sliding block, force evaluations.
TRANSITIONS, SLIDING, GLOBAL, LAST, EVALUATIONS = range(5)
COUNT_SIZE = 5
# A leg is the steps up to the next change of a mode, and not more than so many. A method returns after so
# many legs, so that Ctrl-C is heard within a second or so.
STEPS_IN_LEG, LEGS_PER_CALL = 1000, 5000

# A call counts references to all arrays of its tuples, which costs more than a step. What is called in every
# step is inlined, and a leg's steps call nothing else.
apart = njit(error_model="numpy", fastmath={"contract"})
inner = njit(error_model="numpy", fastmath={"contract"}, forceinline=True)
_entry = njit(error_model="numpy", fastmath={"contract"}, nogil=True)
STAMP = stamp(Path(__file__).parent)


def outer(function: Callable[..., Any]) -> Any:
    """Compile what Python calls, and keep it until a file of this package is edited."""
    return kept(_entry(function), STAMP)


class System(NamedTuple):
    """What stays: 1/m, V, and for each column the spring behind [N/m], mu_s w and mu_k w [N]."""

    inverse_mass: float
    drive_velocity: float
    spring: FloatArray
    strength: FloatArray
    friction: FloatArray


class State(NamedTuple):
    """What changes: spring force [N], velocity [m/s], mode, 1/m where a block slides, mode_i mu_k w_i [N]."""

    tension: FloatArray
    velocity: FloatArray
    mode: NDArray[np.int64]
    mobility: FloatArray
    push: FloatArray


class Record(NamedTuple):
    """Transitions, as in `Run.transitions`, and the time since the one before [s]."""

    time: FloatArray
    block: NDArray[np.int64]
    mode: NDArray[np.int64]
    tangential_load: FloatArray
    interval: FloatArray


def system_of(chain: Chain) -> System:
    """Put a chain into columns.

    Raises
    ------
    ValueError
        If the chain has viscosity, interface springs or a head.
    """
    require_plain(chain)
    return System(
        1.0 / chain.mass,
        chain.drive_velocity,
        *(np.pad(values, 1) for values in (chain.springs, chain.strength, chain.kinetic_friction)),
    )


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
    state.push[:] = system.friction
    return state


def new_record(room: int) -> Record:
    """Room for transitions."""
    return Record(
        np.empty(room), np.empty(room, np.int64), np.empty(room, np.int64), np.empty(room), np.empty(room)
    )


def with_room(record: Record, used: int, n_blocks: int) -> Record:
    """Enlarge a record so that at least one step of transitions fits in."""
    needed = used + n_blocks + 2
    if needed <= len(record.time):
        return record
    larger = new_record(2 * needed)
    for new, old in zip(larger, record, strict=True):
        new[:used] = old[:used]
    return larger


@inner
def rates(system, state, last, tension, velocity, d_tension, d_velocity):
    """Right-hand side (Eqs. 2-6) of blocks 1..last; those ahead of the front rest."""
    spring, mobility, push = system.spring, state.mobility, state.push
    for i in range(1, last + 1):
        d_tension[i] = spring[i] * (velocity[i - 1] - velocity[i])
        d_velocity[i] = mobility[i] * (tension[i] - tension[i + 1] - push[i])
    d_tension[last + 1] = spring[last + 1] * velocity[last]
    d_velocity[last + 1] = 0.0


@inner
def accelerate(state, last, h):
    """Change the velocities of blocks 1..last by h times the acceleration (Eqs. 2-4)."""
    tension, velocity, mobility, push = state.tension, state.velocity, state.mobility, state.push
    for i in range(1, last + 1):
        velocity[i] += h * mobility[i] * (tension[i] - tension[i + 1] - push[i])


@inner
def stretch(system, state, last, h):
    """Change the spring forces by what blocks 1..last move in a time h at their velocities."""
    tension, velocity, spring = state.tension, state.velocity, system.spring
    for i in range(1, last + 1):
        tension[i] += h * spring[i] * (velocity[i - 1] - velocity[i])
    tension[last + 1] += h * spring[last + 1] * velocity[last]


@inner
def resting_mode(system, state, i):
    """Mode of a block with zero velocity: it sticks within mu_s w (Eq. 5), or follows the force."""
    net = state.tension[i] - state.tension[i + 1]
    if abs(net) <= system.strength[i]:
        return 0
    return 1 if net > 0.0 else -1


@apart
def change_mode(system, state, record, clock, count, i, new):
    """Set a block's new mode and record it."""
    set_mode(system, state, count, i, new)
    note(state, record, clock, count, i, new)


@inner
def set_mode(system, state, count, i, new):
    """Set a block's new mode; the number of sliding blocks and the farthest one are kept up to date."""
    old = state.mode[i]
    state.mode[i] = new
    state.mobility[i] = system.inverse_mass if new != 0 else 0.0
    state.push[i] = new * system.friction[i]
    count[SLIDING] += abs(new) - abs(old)
    if count[SLIDING] == state.mode.shape[0] - 2:
        count[GLOBAL] = 1
    last = max(count[LAST], i)
    while last > 0 and state.mode[last] == 0:
        last -= 1
    count[LAST] = last


@apart
def note(state, record, clock, count, i, new):
    """Record a transition."""
    k = count[TRANSITIONS]
    record.time[k] = clock[ONSET] + clock[ELAPSED]
    record.block[k], record.mode[k], record.tangential_load[k] = i, new, state.tension[1]
    record.interval[k] = clock[CARRIED] + (clock[ELAPSED] - clock[NOTED])
    clock[NOTED], clock[CARRIED] = clock[ELAPSED], 0.0
    count[TRANSITIONS] += 1


@inner
def all_keep_their_modes(system, state, last):
    """Whether no sliding block's velocity has changed its sign and no stuck block's force exceeds mu_s w.

    Ahead of the block after the last that slides no force changes, so no block lets go there.
    """
    tension, velocity, mode, strength = state.tension, state.velocity, state.mode, system.strength
    for i in range(1, min(last + 1, mode.shape[0] - 2) + 1):
        if mode[i] != 0:
            if not velocity[i] * mode[i] >= 0.0:
                return False
        elif not abs(tension[i] - tension[i + 1]) <= strength[i]:
            return False
    return True


@apart
def switch(system, state, record, clock, count):
    """Change modes at the end of a step, on the sign of the velocity: stop, turn round or let go."""
    for i in range(1, min(count[LAST] + 1, state.mode.shape[0] - 2) + 1):
        old = state.mode[i]
        if old != 0:
            if state.velocity[i] * old >= 0.0:
                continue
            state.velocity[i] = 0.0
        new = resting_mode(system, state, i)
        if new != old:
            change_mode(system, state, record, clock, count, i, new)


@inner
def start_clock(clock):
    """Count the time from now on, so that short times are not rounded as long ones."""
    clock[ONSET] += clock[ELAPSED]
    clock[CARRIED] += clock[ELAPSED] - clock[NOTED]
    clock[ELAPSED] = clock[NOTED] = 0.0


@apart
def rest(system, state, clock, count, duration, until_global, skipping):
    """All blocks stick: end the run, or wait in closed form (where `skipping`) until block 1 is at its limit.

    Returns MOVING where the run goes on.
    """
    if count[GLOBAL] != 0 and until_global:
        return GLOBAL_SLIP
    if clock[NOTED] > 0.0 or skipping:
        start_clock(clock)
    if not skipping:
        return MOVING
    tension = state.tension
    loading_rate = system.spring[1] * system.drive_velocity
    limit = tension[2] + system.strength[1]
    wait = max((limit - tension[1]) / loading_rate, 0.0)
    remaining = duration - clock[ONSET]
    if wait >= remaining:
        tension[1] += loading_rate * max(remaining, 0.0)
        clock[ELAPSED] = max(remaining, 0.0)
        return FINISHED
    tension[1] = max(tension[1], limit)
    clock[ELAPSED] = wait
    start_clock(clock)
    return MOVING


@inner
def obstacle(state, record, count):
    """Why no step can be made: a full record, or motion beyond all numbers; MOVING if it can."""
    if count[TRANSITIONS] + state.mode.shape[0] > record.time.shape[0]:
        return PAUSED
    return MOVING if math.isfinite(state.tension[1]) else DIVERGED


@apart
def begin_leg(system, state, record, clock, count, duration, until_global, skipping):
    """Whether steps are to be made (MOVING) or why not; where all blocks stick, wait and let block 1 go."""
    status = obstacle(state, record, count)
    if status == MOVING and count[SLIDING] == 0:
        status = rest(system, state, clock, count, duration, until_global, skipping)
        if status == MOVING and skipping:
            change_mode(system, state, record, clock, count, 1, 1)
    if status == MOVING and step_length(clock, duration, duration) <= 0.0:
        return FINISHED
    return status


@inner
def step_length(clock, duration, step):
    """The step [s], cut at the end of the run."""
    return min(step, duration - clock[ONSET] - clock[ELAPSED])
