"""The state of a chain at any time, from what was recorded."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from precursors.model.chain import Chain, FloatArray
from precursors.solver.kernel.arrays import ROW, memory_for, recorded, words
from precursors.solver.kernel.compiled import inner, outer, unfused
from precursors.solver.kernel.events import last_column
from precursors.solver.kernel.friction import farthest_sliding, set_mode, take_mode
from precursors.solver.kernel.layout import WINDOW
from precursors.solver.kernel.pointers import row_address
from precursors.solver.kernel.series import (
    begin,
    expand,
    move,
    order_at,
    take_net_force,
)
from precursors.solver.kernel.units import lay_out, parameters
from precursors.solver.record import TRANSITION, States


def evaluate(
    chain: Chain,
    sorted_times: FloatArray,
    transitions: NDArray[np.void],
    intervals: FloatArray,
    states: States,
) -> tuple[FloatArray, FloatArray]:
    """Spring forces [N] and velocities [m/s] of the blocks at each of `sorted_times`
    [s]."""
    record = np.zeros(len(intervals), ROW)
    for name in TRANSITION.names or ():
        record[name][:-1] = transitions[name]
    record["time"][-1] = np.inf  # after the last transition none comes any more
    record["interval"] = intervals
    found = np.empty((2, len(sorted_times), chain.n_blocks))
    numbers = np.array(parameters(chain))
    weights = np.array(chain.weights)
    go_through(
        numbers,
        weights,
        sorted_times,
        found,
        words(record),
        states,
        memory_for(chain.n_blocks),
    )
    return found[0], found[1]


@outer
def go_through(parameters, weights, times, found, record, states, memory):
    """Fill `found` with spring forces and velocities, from stored states and
    transitions."""
    chain, motion = lay_out(parameters, weights, memory)
    rows = row_address(record, 0)
    # Velocities and spring forces in two doubles stand side by side: what a motion
    # changes for good.
    state = memory[3 * motion.wide : 6 * motion.wide]
    before = np.empty_like(state)
    nearest = 0
    done = 0
    offset = states.offset[0]
    take_state(0, states, chain, motion)
    for q in range(times.shape[0]):
        stored = nearest
        while nearest + 1 < states.after.shape[0] and (
            time_of(states.after[nearest + 1], rows) + states.offset[nearest + 1]
            <= times[q]
        ):
            nearest += 1
        if nearest > stored and states.after[nearest] > done:
            done = states.after[nearest]
            offset = states.offset[nearest]
            take_state(nearest, states, chain, motion)
        while recorded(done, rows).time <= times[q]:
            transition = recorded(done, rows)
            propagate((transition.interval - offset) / chain.tau, chain, motion)
            set_mode(transition.block, transition.mode, chain, motion)
            done += 1
            offset = 0.0
        since = times[q] - time_of(done, rows)
        # Whole windows are gone through once, so that many times in one slip cost no
        # more than the slip.
        is_moving = motion.mode[farthest_sliding(chain.n_blocks, motion.mode)] != 0
        while since - offset > WINDOW * chain.tau and is_moving:
            propagate(WINDOW, chain, motion)
            offset += WINDOW * chain.tau
        before[:] = state
        propagate(max(since - offset, 0.0) / chain.tau, chain, motion)
        for i in range(chain.n_blocks):
            found[0, q, i] = motion.spring_force[i + 1]
            found[1, q, i] = motion.velocity[i + 1] * chain.speed
        state[:] = before


@inner
def time_of(n, rows):
    """Time of the n-th transition; 0 at the start."""
    return recorded(n - 1, rows).time if n > 0 else 0.0


@inner
def take_state(row, states, chain, motion):
    """Take a stored state."""
    for i in range(1, chain.n_blocks + 1):
        motion.velocity[i] = states.velocity[row, i - 1] / chain.speed
        motion.spring_force[i] = states.force[row, i - 1]
        motion.force_rest[i] = 0.0
        motion.mode[i] = states.mode[row, i - 1]
        take_mode(i, chain, motion)


@unfused
def propagate(span, chain, motion):
    """Advance a state by `span`, within which no mode changes."""
    force = motion.spring_force
    n_blocks = chain.n_blocks
    farthest = farthest_sliding(n_blocks, motion.mode)
    if motion.mode[farthest] == 0:
        force[1] += chain.coupling[1] * chain.drive_velocity * span
        return
    end = last_column(chain, farthest)
    first_row = 2
    for i in range(1, end + 1):
        take_net_force(i, motion)
    while span > 0.0:
        s = min(span, WINDOW)
        begin(end, motion)
        expand(first_row, order_at(s), end, chain, motion)
        move(s, end, chain, motion)
        span -= s
