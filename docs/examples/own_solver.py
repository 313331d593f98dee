"""Score your own solver on a problem whose transitions are proved.

SciPy's DOP853 solves the problem `uniform`, with the equations of docs/benchmark.md. SciPy detects an
event only if the sign of its function changes from one step to the next. A tight tolerance is therefore
not enough: the steps must be short.

Prints:
    steps of any length: 953 of 1428 right, then missed: block 4 to mode 1 at 7.03910579118 s
    steps of at most 0.5 us: 1428 of 1428 right, then missed: none
"""

import csv

import numpy as np
from scipy.integrate import solve_ivp

from precursors.benchmark.score import score

N, MU_S, MU_K, DURATION = 10, 0.7, 0.45, 10.0
ACCURACY = {"rtol": 1e-11, "atol": np.repeat([1e-12, 1e-15], N)}  # N, m/s
MASS = 0.012 / N
SPEED = 1e-4
SPRINGS = np.array([0.8e6] + [N * 2.5e6] * (N - 1))
WEIGHTS = np.full(N, 400.0 / N)
LOADING = SPRINGS[0] * SPEED  # rate of the force on block 1 at rest [N/s]


def net_forces(state):
    """Net spring forces n_i; a state holds the spring forces T_i, then the velocities v_i."""
    return state[:N] - np.append(state[1:N], 0.0)


def rates(_, state, mode):
    """Derivatives of the state; a sticking block has no acceleration."""
    velocity = state[N:]
    behind = np.append(SPEED, velocity[:-1])
    acceleration = (net_forces(state) - mode * MU_K * WEIGHTS) / MASS
    return np.append(SPRINGS * (behind - velocity), acceleration * (mode != 0))


def event(block):
    """Return a function that falls to zero at the next transition of a block."""

    def function(_, state, mode):
        if mode[block]:
            return mode[block] * state[N + block]
        return MU_S * WEIGHTS[block] - abs(net_forces(state)[block])

    function.terminal = True
    function.direction = -1
    return function


def solve(longest_step):
    """Return the time, block, mode and tangential load of each transition."""
    state, mode, time = np.zeros(2 * N), np.zeros(N), 0.0
    events = [event(block) for block in range(N)]
    options = {"args": (mode,), "events": events, "max_step": longest_step, **ACCURACY}
    rows = []
    while True:
        if mode.any():
            step = solve_ivp(rates, (time, DURATION), state, "DOP853", **options)
            state, time = step.y[:, -1], step.t[-1]
            changed = [block for block in range(N) if len(step.t_events[block])]
        else:
            wait = (MU_S * WEIGHTS[0] - net_forces(state)[0]) / LOADING
            state[0] += LOADING * wait
            time += wait
            changed = [0]
        if not changed or time > DURATION:
            return rows
        block = changed[0]
        force = net_forces(state)[block]
        sticks = mode[block] and abs(force) <= MU_S * WEIGHTS[block]
        mode[block] = 0 if sticks else np.sign(force)
        state[N + block] = 0.0
        rows.append((time, block + 1, int(mode[block]), state[0]))


for steps, longest in {"of any length": np.inf, "of at most 0.5 us": 5e-7}.items():
    with open("mine.csv", "w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(["time_s", "block", "mode", "tangential_load_N"])
        writer.writerows(solve(longest))
    result = score("mine.csv", "uniform")
    right = f"{result['transitions_right']} of {result['transitions_true']} right"
    print(f"steps {steps}: {right}, then missed: {result['should_be']}")
