"""DOP853 in compiled code, with dense output on which events are located, started anew
at each transition.

Dormand and Prince's pair of order 8 with errors of order 5 and 3 and dense output of
order 7 (E. Hairer, S. P. Norsett and G. Wanner, Solving Ordinary Differential Equations
I, 1993, II.5-II.10). Coefficients, error norm and step control are SciPy's. So a run
tells how much of `scipy_dop853` is the method, and how much is Python. Events are
looked for at `PROBES` points of each step, so that two roots in one step are not
missed.
"""

from __future__ import annotations

import math
from functools import partial

import numpy as np
from scipy.integrate import DOP853

from maegawa2010.methods.common import Method
from maegawa2010.methods.compiled import apart, inner, outer, template
from maegawa2010.methods.equations import by_mode, copy, event_function, rates
from maegawa2010.methods.events import nudge_starting
from maegawa2010.methods.fixed_step import begin_leg, feels, switch
from maegawa2010.methods.march import march

STAGES = 12
# Row s: shares of the stages before s in the state of stage s. Stage 12 is the end of
# the step, then come three for the dense output, whose rows of shares are DENSE.
A = np.zeros((16, 16))
A[:STAGES, :STAGES] = DOP853.A
A[STAGES, :STAGES] = DOP853.B
A[STAGES + 1 :] = DOP853.A_EXTRA
DENSE, FIFTH, THIRD = map(np.ascontiguousarray, (DOP853.D, DOP853.E5, DOP853.E3))
# Of the step: caution, exponent of the error and largest growth, as in SciPy; the first
# over its order.
SAFETY = 0.9
EXPONENT = -1.0 / 8.0
LONGER = 10.0
FIRST_STEP = 3.0
TINY = float(np.finfo(float).tiny)  # so that an error is not 0/0
PROBES = 8
CORRECTIONS = 60
ROOT_ERROR = 1e-15


@inner
def stages(system, state, last, h, k, end, trial):
    """Rates `k` of all stages of a step h, the first being known, and the state at its
    end."""
    for stage in range(1, 16):
        copy(state, last, trial)
        for before in range(stage):
            share = h * A[stage, before]
            if share != 0.0:
                for row in range(2):
                    for i in range(1, last + 2):
                        trial[row, i] += share * k[before, row, i]
        rates(by_mode, system, state, last, trial, k[stage])
        if stage == STAGES:
            copy(trial, last, end)


@inner
def error_of(state, last, end, h, k, tolerance):
    """Error of a step, where 1 is allowed: the norm of II.10."""
    fifth = third = TINY
    for row in range(2):
        for i in range(1, last + 2):
            scale = tolerance * (1.0 + max(abs(state[row, i]), abs(end[row, i])))
            a = b = 0.0
            for stage in range(STAGES):
                a += FIFTH[stage] * k[stage, row, i]
                b += THIRD[stage] * k[stage, row, i]
            fifth += (a / scale) * (a / scale)
            third += (b / scale) * (b / scale)
    n = 2 * (state.shape[1] - 2)
    return h * fifth / math.sqrt((fifth + 0.01 * third) * n)


@inner
def polynomial(state, last, end, h, k, f):
    """Coefficients `f` of the dense output."""
    for row in range(2):
        for i in range(1, last + 2):
            change = end[row, i] - state[row, i]
            start = h * k[0, row, i] - change
            f[0, row, i] = change
            f[1, row, i] = start
            f[2, row, i] = 2.0 * change - h * (k[0, row, i] + k[STAGES, row, i])
            for power in range(4):
                total = 0.0
                for stage in range(16):
                    total += h * DENSE[power, stage] * k[stage, row, i]
                f[3 + power, row, i] = total


@apart
def functions_at(x, system, state, last, f, result, values):
    """State at the part x of a step by the dense output, and the event functions in it;
    the least of them."""
    for row in range(2):
        for i in range(1, last + 2):
            y = 0.0
            for power in range(7):
                y = (y + f[6 - power, row, i]) * (x if power % 2 == 0 else 1.0 - x)
            result[row, i] = state[row, i] + y
    least = math.inf
    for i in range(1, feels(state, last) + 1):
        values[i] = event_function(system, state, result, i)
        least = min(least, values[i])
    return least


@inner
def first_root(low, high, before, after, system, state, last, f, result, values):
    """First root between two parts of a step, with values of the functions there, and
    its block."""
    root = high
    block = 0
    for j in range(1, feels(state, last) + 1):
        if after[j] >= 0.0:
            continue
        a = low
        b = high
        g = max(before[j], 0.0)
        g_b = after[j]
        x = high
        for _ in range(
            CORRECTIONS
        ):  # false position, halving the value of an end that stays (Illinois)
            x_before = x
            x = b - g_b * (b - a) / (g_b - g)
            functions_at(x, system, state, last, f, result, values)
            if values[j] < 0.0:
                b = x
                g_b = values[j]
                g = 0.5 * g
            else:
                a = x
                g = values[j]
                g_b = 0.5 * g_b
            if x == x_before or b - a < ROOT_ERROR or values[j] == 0.0:
                break
        if block == 0 or x < root:
            root = x
            block = j
    return root, block


@template
def advance(motion, tolerance):
    """Go on to the next event, or to the end of the run: the block, or 0."""
    system = motion.system
    state = motion.state
    progress = motion.progress[0]
    n = state.shape[1]
    last = progress.last
    k = np.zeros((len(A), 2, n))
    f = np.zeros((7, 2, n))
    end = np.zeros((2, n))
    trial = state[:2].copy()
    before = np.zeros(n)
    after = np.zeros(n)
    rates(by_mode, system, state, last, state, k[0])
    functions_at(0.0, system, state, last, f, trial, before)
    progress.evaluations += 1
    longest = FIRST_STEP * tolerance**-EXPONENT
    while progress.elapsed < progress.remaining:
        remaining = progress.remaining - progress.elapsed
        h = min(longest, remaining)
        stages(system, state, last, h, k, end, trial)
        progress.evaluations += 15
        error = error_of(state, last, end, h, k, tolerance)
        change = SAFETY * error**EXPONENT
        if not error < 1.0:
            longest = h * change
            continue
        if h == longest:
            longest = h * min(change, LONGER)
        polynomial(state, last, end, h, k, f)
        for probe in range(1, PROBES + 1):
            high = probe / PROBES
            if functions_at(high, system, state, last, f, trial, after) < 0.0:
                low = (probe - 1) / PROBES
                root, block = first_root(
                    low, high, before, after, system, state, last, f, trial, end[0]
                )
                functions_at(root, system, state, last, f, trial, after)
                progress.elapsed += root * h
                copy(trial, last, state)
                return block
            before, after = after, before
        progress.elapsed = (
            progress.remaining if h == remaining else progress.elapsed + h
        )
        copy(end, last, state)
        copy(k[STAGES], last, k[0])
    return 0


@outer
def run_dop853(motion, tolerance):
    """Run from event to event."""
    while begin_leg(motion):
        nudge_starting(motion.state)
        switch(motion, advance(motion, tolerance))


# rtol is the tolerance, atol the same number in N and N/tau (see `columns`).
solve_dop853 = partial(march, run_dop853, scaled=True)
METHODS = (Method("dop853", "relative tolerance", solve_dop853),)
