"""Compute the state of a chain at any time from its record."""

import numpy as np
from numpy.typing import NDArray

from precursors.model.chain import FREE, Chain, FloatArray
from precursors.solver.kernel.arrays import (
    COUPLING,
    FORCE_REST,
    MODE,
    SPRING_FORCE,
    VELOCITY,
    memory_for,
)
from precursors.solver.kernel.decorators import inner, outer, unfused
from precursors.solver.kernel.events import last_column, run_batch
from precursors.solver.kernel.friction import (
    farthest_sliding,
    is_at_rest,
    set_mode,
    take_mode,
)
from precursors.solver.kernel.layout import WINDOW
from precursors.solver.kernel.series import (
    begin,
    expand,
    move,
    order_at,
    take_net_force,
)
from precursors.solver.kernel.units import parameters, set_up
from precursors.solver.record import States

# Speed [m/s] of a block at the instant of its release. It gives the direction, so that
# a run which starts from this state has the block slide from time 0.
JUST_RELEASED = 1e-200


def evaluate(
    chain: Chain,
    sorted_times: FloatArray,
    transitions: NDArray[np.void],
    intervals: FloatArray,
    states: States,
    n_blocks: int,
) -> FloatArray:
    """Return spring forces [N] and velocities [m/s] of the first blocks at each of
    `sorted_times` [s], shape (2, number of times, n_blocks)."""
    # Times of the start and of the transitions; `nearest` is the last stored state
    # before each time.
    instants = np.append(0.0, transitions["time"])
    stored = instants[states.after] + states.offset
    nearest = np.searchsorted(stored, sorted_times, side="right") - 1
    states_at = np.empty((2, len(sorted_times), n_blocks))
    go_through(
        np.array(parameters(chain)),
        np.array(chain.weights),
        sorted_times,
        states_at,
        instants,
        intervals,
        transitions["block"].astype(np.int64),
        transitions["mode"].astype(np.int64),
        states,
        nearest,
        memory_for(chain.n_blocks),
    )
    return states_at


@outer
def go_through(
    parameters,
    weights,
    times,
    states_at,
    instants,
    intervals,
    blocks,
    modes,
    states,
    nearest,
    motion,
):
    """Fill `states_at` with spring forces and velocities, from stored states and
    transitions."""
    chain = set_up(parameters, weights, motion)
    # Consecutive rows: velocities, and spring forces in two doubles, which is all that
    # a motion changes.
    state = motion[VELOCITY : FORCE_REST + 1]
    before = np.empty_like(state)
    done = 0
    offset = states.offset[0]
    take_state(0, states, chain, motion)
    for q in range(times.size):
        if states.after[nearest[q]] > done:
            done = states.after[nearest[q]]
            offset = states.offset[nearest[q]]
            take_state(nearest[q], states, chain, motion)
        while done < blocks.size and instants[done + 1] <= times[q]:
            propagate((intervals[done] - offset) / chain.tau, chain, motion)
            set_mode(blocks[done], modes[done], chain, motion)
            done += 1
            offset = 0.0
        since = times[q] - instants[done]
        # Complete windows are computed once, so many times within one slip cost no more
        # than the slip.
        is_moving = not is_at_rest(chain, motion)
        while since - offset > WINDOW * chain.tau and is_moving:
            propagate(WINDOW, chain, motion)
            offset += WINDOW * chain.tau
        copy(state, before)
        propagate(max(since - offset, 0.0) / chain.tau, chain, motion)
        for i in range(states_at.shape[2]):
            states_at[0, q, i] = motion[SPRING_FORCE, i + 1]
            states_at[1, q, i] = motion[VELOCITY, i + 1] * chain.speed
            mode = motion[MODE, i + 1]
            if states_at[1, q, i] == 0.0 and mode != 0 and mode != FREE:
                states_at[1, q, i] = mode * JUST_RELEASED
        copy(before, state)


@inner
def copy(rows, into):
    """Copy rows in a loop, because `into[:] = rows` takes a second to compile."""
    for n in range(rows.shape[0]):
        for i in range(rows.shape[1]):
            into[n, i] = rows[n, i]


def should_compile_evaluation() -> bool:
    """Whether this process has compiled the event loop, but not yet `go_through`.

    Compiling both at once saves the user a second wait.
    """
    return bool(run_batch.stats.cache_misses) and not go_through.signatures


@inner
def take_state(row, states, chain, motion):
    """Make a stored state the present one."""
    for i in range(1, chain.n_blocks + 1):
        motion[VELOCITY, i] = states.velocity[row, i - 1] / chain.speed
        motion[SPRING_FORCE, i] = states.force[row, i - 1]
        motion[FORCE_REST, i] = 0.0
        motion[MODE, i] = states.mode[row, i - 1]
        take_mode(i, motion)


@unfused
def propagate(span, chain, motion):
    """Advance a state by `span`, during which no mode changes."""
    if is_at_rest(chain, motion):
        motion[SPRING_FORCE, 1] += motion[COUPLING, 1] * chain.drive_velocity * span
        return
    end = last_column(chain, farthest_sliding(chain.n_blocks, motion))
    for i in range(1, end + 1):
        take_net_force(i, motion)
    while span > 0.0:
        s = min(span, WINDOW)
        begin(end, motion)
        expand(2, order_at(s), end, motion)
        move(s, end, chain, motion)
        span -= s
