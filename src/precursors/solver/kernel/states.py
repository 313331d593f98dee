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
    # Transitions before each time, the time since the last of them, and the last state that comes before.
    begin_at = np.append(0.0, transitions["time"])
    done = np.searchsorted(begin_at[1:], sorted_times, side="right")
    since = sorted_times - begin_at[done]
    nearest = np.searchsorted(begin_at[states.after] + states.offset, sorted_times, side="right") - 1
    force, velocity = found = np.empty((2, len(sorted_times), chain.n_blocks))
    numbers, weights = np.array(parameters(chain)), np.array(chain.weights)
    wanted, memory = (done, since, nearest), memory_for(chain.n_blocks)
    go_through(numbers, weights, wanted, found, words(record), states, memory)
    return force, velocity


@outer
def go_through(parameters, weights, wanted, found, record, states, memory):
    """Fill `found` with spring forces and velocities, from stored states and transitions."""
    chain, motion = lay_out(parameters, weights, memory)
    rows = row_address(record, 0)
    # Velocities and spring forces in two doubles stand side by side: what a motion changes for good.
    state = memory[3 * motion.wide : 6 * motion.wide]
    before = np.empty_like(state)
    target, since, nearest = wanted
    done, last = 0, -1
    offset = 0.0
    for q in range(target.shape[0]):
        if nearest[q] > last and (last < 0 or states.after[nearest[q]] > done):
            done, offset = states.after[nearest[q]], states.offset[nearest[q]]
            take_state(nearest[q], states, chain, motion)
        last = nearest[q]
        while done < target[q]:
            transition = recorded(done, rows)
            propagate((transition.interval - offset) / chain.tau, chain, motion)
            set_mode(transition.block, transition.mode, chain, motion)
            done += 1
            offset = 0.0
        # Whole windows are gone through once, so that many times in one slip cost no more than the slip.
        is_moving = motion.mode[farthest_sliding(chain.n_blocks, motion.mode)] != 0
        while since[q] - offset > WINDOW * chain.tau and is_moving:
            propagate(WINDOW, chain, motion)
            offset += WINDOW * chain.tau
        for i in range(state.shape[0]):
            before[i] = state[i]
        propagate(max(since[q] - offset, 0.0) / chain.tau, chain, motion)
        for i in range(1, chain.n_blocks + 1):
            found[0, q, i - 1] = motion.spring_force[i]
            found[1, q, i - 1] = motion.velocity[i] * chain.speed
        for i in range(state.shape[0]):
            state[i] = before[i]


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
