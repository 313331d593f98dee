"""DOP853 in compiled code, with dense output on which events are located, started anew at each transition.

Dormand and Prince's pair of order 8 with errors of order 5 and 3 and dense output of order 7 (E. Hairer, S.
P. Norsett and G. Wanner, Solving Ordinary Differential Equations I, 1993, II.5-II.10). Coefficients, error
norm and step control are SciPy's. So a run tells how much of `scipy_dop853` is the method, and how much is
Python. Events are looked for at `PROBES` points of each step, so that two roots in one step are not missed.
"""

from __future__ import annotations

import math
from functools import partial

import numpy as np
from scipy.integrate import DOP853

from precursors.methods.common import Method, Result
from precursors.methods.events import Motion, compiled, event_functions, march_restarting, rates
from precursors.model.chain import Chain

STAGES = 12
# Row s: shares of the stages before s in the state of stage s. Stage 12 is the end of the step, then come
# three for the dense output, whose rows of shares are DENSE.
A = np.zeros((16, 16))
A[:STAGES, :STAGES], A[STAGES, :STAGES], A[STAGES + 1 :] = DOP853.A, DOP853.B, DOP853.A_EXTRA
DENSE, FIFTH, THIRD = map(np.ascontiguousarray, (DOP853.D, DOP853.E5, DOP853.E3))
# Of the step: caution, exponent of the error and limits of the change, as in SciPy; the first over its order.
SAFETY, EXPONENT, SHORTER, LONGER, FIRST_STEP = 0.9, -1.0 / 8.0, 0.2, 10.0, 3.0
PROBES, CORRECTIONS, TIGHT, ROOT_ERROR = 8, 60, 1e-10, 1e-15


@compiled
def stages(state, settings, coupling, drive_velocity, h, k, end, trial):
    """Rates `k` of all stages of a step h, the first being known, and the state at its end."""
    for stage in range(1, 16):
        trial[:] = state
        for before in range(stage):
            share = h * A[stage, before]
            if share != 0.0:
                for i in range(state.shape[0]):
                    trial[i] += share * k[before, i]
        rates(trial, settings, coupling, drive_velocity, k[stage])
        if stage == STAGES:
            end[:] = trial


@compiled
def error_of(state, end, h, k, tolerance):
    """Error of a step, where 1 is allowed: the norm of II.10."""
    fifth = third = 0.0
    for i in range(state.shape[0]):
        scale = tolerance * (1.0 + max(abs(state[i]), abs(end[i])))
        a = b = 0.0
        for stage in range(STAGES):
            a += FIFTH[stage] * k[stage, i]
            b += THIRD[stage] * k[stage, i]
        fifth += (a / scale) ** 2
        third += (b / scale) ** 2
    return h * fifth / math.sqrt((fifth + 0.01 * third) * state.shape[0]) if fifth > 0.0 else 0.0


@compiled
def polynomial(state, end, h, k, f):
    """Coefficients `f` of the dense output."""
    for i in range(state.shape[0]):
        f[0, i] = end[i] - state[i]
        f[1, i] = h * k[0, i] - f[0, i]
        f[2, i] = 2.0 * f[0, i] - h * (k[0, i] + k[STAGES, i])
        for row in range(4):
            f[3 + row, i] = 0.0
            for stage in range(16):
                f[3 + row, i] += h * DENSE[row, stage] * k[stage, i]


@compiled
def functions_at(x, state, settings, strength, f, result, values):
    """State at the part x of a step by the dense output, and the event functions in it."""
    for i in range(state.shape[0]):
        y = 0.0
        for row in range(7):
            y = (y + f[6 - row, i]) * (x if row % 2 == 0 else 1.0 - x)
        result[i] = state[i] + y
    event_functions(result, settings, strength, values)


@compiled
def first_root(low, high, before, after, state, settings, strength, f):
    """First root between two parts of a step, with values of the functions there, and its event."""
    result, values = np.empty_like(state), np.empty_like(state)
    root, event = high, -1
    for j in range(state.shape[0]):
        if after[j] >= 0.0:
            continue
        a, b, g, g_b, x = low, high, max(before[j], 0.0), after[j], high
        for _ in range(CORRECTIONS):  # false position, halving the value of an end that stays (Illinois)
            x_before, x = x, b - g_b * (b - a) / (g_b - g)
            functions_at(x, state, settings, strength, f, result, values)
            if values[j] < 0.0:
                b, g_b, g = x, values[j], 0.5 * g
            else:
                a, g, g_b = x, values[j], 0.5 * g_b
            if x == x_before or b - a < ROOT_ERROR or values[j] == 0.0:
                break
        if event < 0 or x < root:
            root, event = x, j
    return root, event


@compiled
def advance(state, settings, coupling, strength, drive_velocity, tolerance, clock):
    """Go on to the next event, or to the end of the run: the number of the event, or -1.

    `clock` is time, end, length of the next step [tau], and evaluations made.
    """
    n = state.shape[0]
    k, f = np.empty((16, n)), np.empty((7, n))
    end, trial, before, after = np.empty((4, n))
    rates(state, settings, coupling, drive_velocity, k[0])
    event_functions(state, settings, strength, before)
    clock[3] += 1
    while clock[0] < clock[1]:
        h = min(clock[2], clock[1] - clock[0])
        stages(state, settings, coupling, drive_velocity, h, k, end, trial)
        clock[3] += 15
        error = error_of(state, end, h, k, tolerance)
        change = SAFETY * max(error, 1e-99) ** EXPONENT
        if not error < 1.0:
            clock[2] = h * max(change, SHORTER)
            continue
        if h == clock[2]:
            clock[2] = h * min(change, LONGER)
        polynomial(state, end, h, k, f)
        for probe in range(1, PROBES + 1):
            functions_at(probe / PROBES, state, settings, strength, f, trial, after)
            if after.min() < 0.0:
                bounds = (probe - 1) / PROBES, probe / PROBES
                root, event = first_root(*bounds, before, after, state, settings, strength, f)
                functions_at(root, state, settings, strength, f, trial, after)
                clock[0] += root * h
                state[:] = trial
                return event
            before[:] = after
        clock[0] = clock[1] if h == clock[1] - clock[0] else clock[0] + h
        state[:], k[0] = end, k[STAGES]
    return -1


def next_transition(motion: Motion, time: float, tolerance: float = TIGHT) -> tuple[float, int]:
    """Go on to the next transition: when it is [tau] and its event, or -1 at the end of the run."""
    clock = np.array([time, motion.remaining, FIRST_STEP * tolerance**-EXPONENT, 0.0])
    event = advance(
        motion.state,
        motion.settings,
        motion.coupling,
        motion.strength,
        motion.drive_velocity,
        tolerance,
        clock,
    )
    motion.evaluations += int(clock[3])
    return float(clock[0]), event


def solve_dop853(chain: Chain, duration: float, tolerance: float, until: str | None = None) -> Result:
    """Run a chain by DOP853; rtol is the tolerance, atol the same number in N and N/tau (see `events`)."""
    motion = Motion(chain, duration, until)
    return march_restarting(motion, partial(next_transition, motion, tolerance=tolerance))


METHODS = (
    Method(
        "dop853",
        "DOP853, compiled",
        "relative tolerance",
        solve_dop853,
        values=(1e-3, 1e-5, 1e-7, 1e-9, 1e-11, 1e-13),
        whole=(1e-7, 1e-9, 1e-11, 1e-13),
        quick=(1e-5, 1e-7, 1e-9, 1e-11),
        quick_whole=(1e-11,),
        color="#000080",
        marker="H",
    ),
)
