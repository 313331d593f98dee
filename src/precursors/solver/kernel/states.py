"""The state of a chain at any time, from what was recorded."""

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

# Speed [m/s] of a block at the very instant of its release, which tells its direction:
# a run that starts there has it slide from time 0.
JUST_RELEASED = 1e-200


def evaluate(
    chain: Chain,
    sorted_times: FloatArray,
    transitions: NDArray[np.void],
    intervals: FloatArray,
    states: States,
    n_blocks: int,
) -> FloatArray:
    """Spring forces [N] and velocities [m/s] of the first blocks, shape (2, number of
    times, n_blocks), at each of `sorted_times` [s]."""
    # Times of the start and of the transitions; the state stored last at each time.
    instants = np.append(0.0, transitions["time"])
    stored = instants[states.after] + states.offset
    nearest = np.searchsorted(stored, sorted_times, side="right") - 1
    found = np.empty((2, len(sorted_times), n_blocks))
    go_through(
        np.array(parameters(chain)),
        np.array(chain.weights),
        sorted_times,
        found,
        instants,
        intervals,
        transitions["block"].astype(np.int64),
        transitions["mode"].astype(np.int64),
        states,
        nearest,
        memory_for(chain.n_blocks),
    )
    return found


@outer
def go_through(
    parameters,
    weights,
    times,
    found,
    instants,
    intervals,
    blocks,
    modes,
    states,
    nearest,
    motion,
):
    """Fill `found` with spring forces and velocities, from stored states and
    transitions."""
    chain = set_up(parameters, weights, motion)
    # Velocities and spring forces in two doubles stand side by side: what a motion
    # changes for good.
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
        # Whole windows are gone through once, so that many times in one slip cost no
        # more than the slip.
        is_moving = not is_at_rest(chain, motion)
        while since - offset > WINDOW * chain.tau and is_moving:
            propagate(WINDOW, chain, motion)
            offset += WINDOW * chain.tau
        copy(state, before)
        propagate(max(since - offset, 0.0) / chain.tau, chain, motion)
        for i in range(found.shape[2]):
            found[0, q, i] = motion[SPRING_FORCE, i + 1]
            found[1, q, i] = motion[VELOCITY, i + 1] * chain.speed
            mode = motion[MODE, i + 1]
            if found[1, q, i] == 0.0 and mode != 0 and mode != FREE:
                found[1, q, i] = mode * JUST_RELEASED
        copy(before, state)


@inner
def copy(rows, into):
    """Copy rows; `into[:] = rows` takes a second to compile."""
    for n in range(rows.shape[0]):
        for i in range(rows.shape[1]):
            into[n, i] = rows[n, i]


def is_compiled_now() -> bool:
    """Whether this process compiled the event loop, and not yet what looks into runs:
    whoever waits for the one shall not wait for the other later."""
    return bool(run_batch.stats.cache_misses) and not go_through.signatures


@inner
def take_state(row, states, chain, motion):
    """Take a stored state."""
    for i in range(1, chain.n_blocks + 1):
        motion[VELOCITY, i] = states.velocity[row, i - 1] / chain.speed
        motion[SPRING_FORCE, i] = states.force[row, i - 1]
        motion[FORCE_REST, i] = 0.0
        motion[MODE, i] = states.mode[row, i - 1]
        take_mode(i, motion)


@unfused
def propagate(span, chain, motion):
    """Advance a state by `span`, within which no mode changes."""
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
