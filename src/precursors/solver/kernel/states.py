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
from precursors.solver.kernel.series import begin, expand, order_at
from precursors.solver.kernel.springs import move, take_net_force
from precursors.solver.kernel.units import lay_out, parameters
from precursors.solver.record import TRANSITION, States


def evaluate(
    chain: Chain,
    sorted_times: FloatArray,
    transitions: NDArray[np.void],
    intervals: FloatArray,
    states: States,
) -> tuple[FloatArray, FloatArray]:
    """Spring forces [N] and velocities [m/s] of the blocks at each of `sorted_times` [s]."""
    record = np.zeros(len(intervals), ROW)
    for name in TRANSITION.names or ():
        record[name][:-1] = transitions[name]
    record["interval"] = intervals
    force, velocity = found = np.empty((2, len(sorted_times), chain.n_blocks))
    numbers, weights = np.array(parameters(chain)), np.array(chain.weights)
    go_through(numbers, weights, sorted_times, found, words(record), states, memory_for(chain.n_blocks))
    return force, velocity


@outer
def go_through(parameters, weights, sorted_times, found, record, states, memory):
    """Fill `found` with spring forces and velocities, from stored states and transitions."""
    chain, motion = lay_out(parameters, weights, memory)
    velocity, force, rest, mode = motion.velocity, motion.spring_force, motion.force_rest, motion.mode
    n_blocks, n_transitions, rows = chain.n_blocks, record.shape[0] - 1, row_address(record, 0)
    kept = np.empty((3, n_blocks + 1))
    target = done = 0
    row = -1
    offset = 0.0
    for q in range(sorted_times.shape[0]):
        now = sorted_times[q]
        while target < n_transitions and recorded(target, rows).time <= now:
            target += 1
        since = now - recorded(target - 1, rows).time if target > 0 else now
        best = nearest_state(max(row, 0), target, since, states)
        if best > row and (row < 0 or states.after[best] > done):
            done, offset = states.after[best], states.offset[best]
            take_state(best, states, chain, motion)
        row = best
        while done < target:
            transition = recorded(done, rows)
            propagate((transition.interval - offset) / chain.tau, chain, motion)
            set_mode(transition.block, transition.mode, chain, motion)
            done += 1
            offset = 0.0
        # Whole windows are gone through once, so that many times in one slip cost no more than the slip.
        while since - offset > WINDOW * chain.tau and mode[farthest_sliding(n_blocks, mode)] != 0:
            propagate(WINDOW, chain, motion)
            offset += WINDOW * chain.tau
        for i in range(1, n_blocks + 1):
            kept[0, i], kept[1, i], kept[2, i] = velocity[i], force[i], rest[i]
        propagate(max(since - offset, 0.0) / chain.tau, chain, motion)
        for i in range(1, n_blocks + 1):
            found[0, q, i - 1], found[1, q, i - 1] = force[i], velocity[i] * chain.speed
            velocity[i], force[i], rest[i] = kept[0, i], kept[1, i], kept[2, i]


@inner
def nearest_state(row, target, since, states):
    """The last stored state, from `row` on, up to `since` [s] after `target` transitions."""
    after, offset = states.after, states.offset
    while row + 1 < after.shape[0] and (
        after[row + 1] < target or (after[row + 1] == target and offset[row + 1] <= since)
    ):
        row += 1
    return row


@inner
def take_state(row, states, chain, motion):
    """Take a stored state."""
    for i in range(1, chain.n_blocks + 1):
        motion.velocity[i] = states.velocity[row, i - 1] / chain.speed
        motion.spring_force[i], motion.force_rest[i] = states.force[row, i - 1], 0.0
        motion.mode[i] = states.mode[row, i - 1]
        take_mode(i, chain, motion)


@unfused
def propagate(span, chain, motion):
    """Advance a state by `span`, within which no mode changes."""
    force, n_blocks = motion.spring_force, chain.n_blocks
    farthest = farthest_sliding(n_blocks, motion.mode)
    if motion.mode[farthest] == 0:
        force[1] += chain.coupling[1] * chain.drive_velocity * span
        return
    end = last_column(chain, farthest)
    for i in range(1, end + 1):
        take_net_force(i, motion)
    first_row = 2
    while span > 0.0:
        s = min(span, WINDOW)
        begin(end, motion)
        expand(first_row, order_at(s), end, chain, motion)
        move(s, end, chain, motion)
        span -= s
