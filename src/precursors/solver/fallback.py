"""Runs of `plain`: what `simulate` and `Run.at` do where there is no compiled kernel."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from precursors.model.chain import Chain, FloatArray
from precursors.solver import plain
from precursors.solver.record import TRANSITION, States


def find(
    chain: Chain,
    start: tuple[FloatArray, FloatArray],
    duration: float,
    until_global: bool,
    longest_slip: float,
    most: int,
) -> tuple[NDArray[np.void], FloatArray, float]:
    """Transitions and intervals of a chain from a start (positions, velocities), and the time reached [s]."""
    state = plain.at_start(chain, *start)
    rows, end, since = plain.find_transitions(chain, state, duration, until_global, longest_slip, most)
    transitions = np.array([(t, block, mode, load) for t, _, block, mode, load in rows], dtype=TRANSITION)
    intervals = np.array([interval for _, interval, *_ in rows] + [since], dtype=np.float64)
    return transitions, intervals, float(end)


def first_state(chain: Chain, positions: FloatArray, velocities: FloatArray) -> States:
    """The state at the start, as the compiled kernel stores it."""
    state = plain.at_start(chain, positions, velocities)
    none = np.zeros((1, chain.n_blocks), np.int64)
    force = state.force[None, 1:-1].astype(np.float64)
    return States(force, velocities[None], none, none[:, 0], np.zeros(1))


def evaluate(
    chain: Chain,
    sorted_times: FloatArray,
    transitions: NDArray[np.void],
    intervals: FloatArray,
    states: States,
) -> tuple[FloatArray, FloatArray]:
    """Spring forces [N] and velocities [m/s] at times [s], from the start through all transitions."""
    velocity = np.r_[chain.drive_velocity, states.velocity[0], 0.0]
    state = plain.State(velocity, np.pad(states.force[0], 1), np.zeros(chain.n_blocks + 2, np.int64))
    force, speed = np.empty((2, len(sorted_times), chain.n_blocks))
    done, now = 0, 0.0
    for q, time in enumerate(sorted_times):
        while done < len(transitions) and transitions["time"][done] <= time:
            state = _propagate(chain, state, intervals[done])
            block, mode = transitions["block"][done], transitions["mode"][done]
            if state.mode[block]:
                state.velocity[block] = 0.0
            state.mode[block] = mode
            now = transitions["time"][done]
            done += 1
        there = _propagate(chain, state, time - now)
        force[q], speed[q] = there.force[1:-1], there.velocity[1:-1]
    return force, speed


def _propagate(chain: Chain, state: plain.State, span: float) -> plain.State:
    """Carry a state forward by `span` [s] without a transition."""
    state = plain.State(state.velocity.copy(), state.force.copy(), state.mode)
    if not state.mode.any():
        state.force[1] += chain.loading_rate * span
        return state
    while span > 0.0:
        window = min(span, plain.REACH / chain.fastest_frequency_bound)
        state = plain.move(state, *plain.expand(chain, state, window), 1.0)
        span -= window
    return state
