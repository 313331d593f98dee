"""The state of a chain at any time, from what was recorded."""

from __future__ import annotations

import math

import numpy as np

from precursors.model.chain import Chain, FloatArray
from precursors.solver.kernel.arrays import (
    MOTION_AT,
    RECORD_AT,
    SEARCH_AT,
    STATE_AT,
    STATES_AT,
    Columns,
    Motion,
    Record,
    Room,
    State,
    States,
    new_additions,
    new_columns,
    new_motion,
    new_search,
    new_state,
    width,
)
from precursors.solver.kernel.compiled import inner, outer, unfused
from precursors.solver.kernel.friction import farthest_sliding, set_mode, take_mode
from precursors.solver.kernel.layout import BEYOND, SHORT_WINDOW, WIDTH
from precursors.solver.kernel.series import expand, order_for, settle
from precursors.solver.kernel.springs import on_springs, renew_grip, stretch_springs
from precursors.solver.kernel.units import is_linked, parameters, set_up


def evaluate(
    chain: Chain, sorted_times: FloatArray, record: Record, states: States
) -> tuple[FloatArray, FloatArray]:
    """Spring forces [N] and velocities [m/s] of the blocks at each of `sorted_times` [s]."""
    n_blocks = chain.n_blocks
    force, velocity = found = np.empty((2, len(sorted_times), n_blocks))
    additions = new_additions(n_blocks) if is_linked(chain) else None
    room = Room(
        new_columns(n_blocks), new_state(n_blocks), new_motion(n_blocks), new_search(0), record, states
    )
    spare = np.zeros((2, width(n_blocks)))
    weights = np.array(chain.weights)
    tau = go_through(
        np.array(parameters(chain)), weights, additions, sorted_times, found, spare, *room.arrays
    )
    return force, velocity * (tau / chain.mass)


@outer
def go_through(parameters, weights, additions, sorted_times, found, spare, *arrays):
    """Fill `found` with spring forces and velocities, from stored states and transitions; return tau [s]."""
    chain, state = Columns(*arrays[:STATE_AT]), State(*arrays[STATE_AT:MOTION_AT])
    motion = Motion(*arrays[MOTION_AT:SEARCH_AT])
    record, states = Record(*arrays[RECORD_AT:STATES_AT]), States(*arrays[STATES_AT:])
    tau, drive_velocity = set_up(parameters, weights, chain, additions)
    velocity, tension, mode = state
    rate, after = motion.rate, states.after
    here, held = spare[0], spare[1]
    n_blocks = mode.shape[0] - 1 - BEYOND
    springy = False
    if additions is not None:
        springy = on_springs(additions)
    target = 0
    row = -1
    done = 0
    offset = advanced = 0.0
    for q in range(sorted_times.shape[0]):
        now = sorted_times[q]
        while target < record.time.shape[0] and record.time[target] <= now:
            target += 1
        since = now - record.time[target - 1] if target > 0 else now
        best = max(row, 0)
        while best + 1 < after.shape[0] and (
            after[best + 1] < target or (after[best + 1] == target and states.offset[best + 1] <= since)
        ):
            best += 1
        is_ahead = best > row and (row < 0 or after[best] > done)
        if springy and best > row and after[best] == done:
            is_ahead = True
        if is_ahead:
            advanced = 0.0
            done, offset = after[best], states.offset[best]
            for i in range(1, n_blocks + 1):
                velocity[i], tension[i] = states.velocity[best, i], states.force[best, i]
                rate[0, i] = velocity[i]
                mode[i] = states.mode[best, i]
                if additions is not None and springy:
                    additions.grip[i] = states.grip[best, i]
                take_mode(i, mode, chain, additions, motion)
            rate[0, 0] = drive_velocity
        row = best
        while done < target:
            span = (record.intervals[done] - offset) / tau - advanced
            propagate(drive_velocity, chain, additions, mode, span, tension, motion)
            set_mode(record.block[done], record.mode[done], chain, additions, state, motion)
            for i in range(1, n_blocks + 1):
                velocity[i] = rate[0, i]
            done += 1
            offset = advanced = 0.0
        span = max(since - offset, 0.0) / tau
        if springy:
            # Nothing rests: what lies behind in whole windows is not gone through again for the next time.
            whole = SHORT_WINDOW * math.floor(span / SHORT_WINDOW)
            propagate(drive_velocity, chain, additions, mode, whole - advanced, tension, motion)
            for i in range(1, n_blocks + 1):
                velocity[i] = rate[0, i]
            advanced = whole
            span -= whole
        for i in range(1, n_blocks + 1):
            here[i] = tension[i]
        if additions is not None:
            for i in range(1, n_blocks + 1):
                held[i] = additions.grip[i]
        propagate(drive_velocity, chain, additions, mode, span, here, motion)
        for i in range(1, n_blocks + 1):
            found[0, q, i - 1], found[1, q, i - 1] = here[i], rate[0, i]
            rate[0, i] = velocity[i]
        if additions is not None:
            for i in range(1, n_blocks + 1):
                additions.grip[i] = held[i]
                take_mode(i, mode, chain, additions, motion)
    return tau


@unfused
def propagate(drive_velocity, chain, additions, mode, span, tension, motion):
    """Carry a state forward by `span` without a transition."""
    rate, slip, before = motion.rate, motion.slip, motion.tension_before
    coupling, _, _, lightness = chain
    if not moves(motion.mobile):
        tension[1] += coupling[1] * drive_velocity * span
        return
    n_blocks = mode.shape[0] - 1 - BEYOND
    last = min(farthest_sliding(n_blocks, mode) + 1, n_blocks)
    if additions is not None and on_springs(additions):
        last = n_blocks
    first, end = 1, WIDTH * ((last + WIDTH - 1) // WIDTH)
    order = order_for(SHORT_WINDOW)
    while span > 0.0:
        s = min(span, SHORT_WINDOW)
        for i in range(end + 2):
            before[i] = tension[i]
            slip[i] = motion.origins[i] = 0.0
        slip[0] = drive_velocity * s
        for n in range(order + 1):
            rate[n, end + 1] = 0.0
        expand(first, end, order, coupling, additions, tension, motion)
        settle(s, first, end, order, motion)
        stretch_springs(first, end, coupling, slip, before, tension)
        if additions is not None and on_springs(additions):
            for i in range(n_blocks + 1):
                before[i] = 0.0
            renew_grip(mode, lightness, additions, motion, before)
        span -= s


@inner
def moves(mobile):
    """Whether anything moves."""
    total = 0.0
    for i in range(mobile.shape[0]):
        total += mobile[i]
    return total > 0.0
