"""The state of a chain at any time, from what was recorded."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from precursors.model.chain import Chain, FloatArray
from precursors.solver.kernel.arrays import BY_COLUMN, ROW, memory_for, recorded, words
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
    # Transitions before each time, the time since the last of them, and the last state that comes before:
    # NumPy sorts complex numbers by their real parts, then by their imaginary ones.
    done = np.searchsorted(transitions["time"], sorted_times, side="right")
    since = sorted_times - np.append(0.0, transitions["time"])[done]
    nearest = np.searchsorted(states.after + 1j * states.offset, done + 1j * since, side="right") - 1
    force, velocity = found = np.empty((2, len(sorted_times), chain.n_blocks))
    numbers, weights = np.array(parameters(chain)), np.array(chain.weights)
    wanted, memory = (done, since, nearest), memory_for(chain.n_blocks)
    go_through(numbers, weights, wanted, found, words(record), states, memory)
    return force, velocity


@outer
def go_through(parameters, weights, wanted, found, record, states, memory):
    """Fill `found` with spring forces and velocities, from stored states and transitions."""
    chain, motion = lay_out(parameters, weights, memory)
    rows, columns = row_address(record, 0), memory[: (3 + BY_COLUMN) * motion.wide]
    target, since, nearest = wanted
    done, state = 0, -1
    offset = 0.0
    for q in range(target.shape[0]):
        if nearest[q] > state and (state < 0 or states.after[nearest[q]] > done):
            done, offset = states.after[nearest[q]], states.offset[nearest[q]]
            take_state(nearest[q], states, chain, motion)
        state = nearest[q]
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
        here = columns.copy()
        propagate(max(since[q] - offset, 0.0) / chain.tau, chain, motion)
        for i in range(1, chain.n_blocks + 1):
            found[0, q, i - 1] = motion.spring_force[i]
            found[1, q, i - 1] = motion.velocity[i] * chain.speed
        columns[:] = here


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
