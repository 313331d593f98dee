"""The state of a chain at any time, from what was recorded."""

from __future__ import annotations

import numpy as np

from precursors.model.chain import Chain, FloatArray
from precursors.solver.kernel.arrays import Record, System, divide, memory_for
from precursors.solver.kernel.compiled import inner, outer, unfused
from precursors.solver.kernel.events import last_column
from precursors.solver.kernel.friction import farthest_sliding, set_mode, take_mode
from precursors.solver.kernel.layout import WINDOW
from precursors.solver.kernel.series import expand, order_at, set_rows
from precursors.solver.kernel.springs import begin, move, take_net_force
from precursors.solver.kernel.units import parameters, set_up
from precursors.solver.record import States


def evaluate(
    chain: Chain, sorted_times: FloatArray, record: Record, states: States
) -> tuple[FloatArray, FloatArray]:
    """Spring forces [N] and velocities [m/s] of the blocks at each of `sorted_times` [s]."""
    force, velocity = found = np.empty((2, len(sorted_times), chain.n_blocks))
    numbers, weights = np.array(parameters(chain)), np.array(chain.weights)
    go_through(numbers, weights, sorted_times, found, record, states, memory_for(chain.n_blocks))
    return force, velocity


@outer
def go_through(parameters, weights, sorted_times, found, record, states, memory):
    """Fill `found` with spring forces and velocities, from stored states and transitions."""
    n_blocks = weights.shape[0]
    columns, motion = divide(memory, n_blocks)
    tau, speed, drive_velocity = set_up(parameters, weights, n_blocks, columns)
    chain = System(n_blocks, tau, speed, drive_velocity, columns[0], columns[1], columns[2])
    motion.rate[0], motion.slides[0] = drive_velocity, 1.0
    target = done = 0
    row = -1
    offset = 0.0
    for q in range(sorted_times.shape[0]):
        now = sorted_times[q]
        while target < record.time.shape[0] and record.time[target] <= now:
            target += 1
        since = now - record.time[target - 1] if target > 0 else now
        best = nearest_state(max(row, 0), target, since, states)
        if best > row and (row < 0 or states.after[best] > done):
            done, offset = states.after[best], states.offset[best]
            take_state(best, states, chain, motion)
        row = best
        while done < target:
            propagate((record.intervals[done] - offset) / tau, chain, motion)
            set_mode(record.block[done], record.mode[done], chain, motion)
            done += 1
            offset = 0.0
        # Whole windows are gone through once, so that many times in one slip cost no more than the slip.
        while since - offset > WINDOW * tau and motion.mode[farthest_sliding(n_blocks, motion.mode)] != 0:
            propagate(WINDOW, chain, motion)
            offset += WINDOW * tau
        for i in range(1, n_blocks + 1):
            motion.saved_velocity[i], motion.saved_force[i] = motion.velocity[i], motion.spring_force[i]
            motion.saved_rest[i] = motion.force_rest[i]
        propagate(max(since - offset, 0.0) / tau, chain, motion)
        for i in range(1, n_blocks + 1):
            found[0, q, i - 1], found[1, q, i - 1] = motion.spring_force[i], motion.velocity[i] * speed
            motion.velocity[i], motion.spring_force[i] = motion.saved_velocity[i], motion.saved_force[i]
            motion.force_rest[i] = motion.saved_rest[i]


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
    """Carry a state forward by `span` without a transition."""
    force, n_blocks = motion.spring_force, chain.n_blocks
    farthest = farthest_sliding(n_blocks, motion.mode)
    if motion.mode[farthest] == 0:
        force[1] += chain.coupling[1] * chain.drive_velocity * span
        return
    end = last_column(chain, farthest)
    for i in range(1, end + 1):
        take_net_force(i, motion)
    while span > 0.0:
        s = min(span, WINDOW)
        begin(end, motion)
        set_rows(end, motion)
        expand(2, order_at(s), end, chain, motion)
        move(s, end, chain, motion)
        span -= s
