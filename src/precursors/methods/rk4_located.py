"""The classical Runge-Kutta method with a fixed step, cut where a block changes its state.

A gauge of each block is positive while its state lasts: its velocity in its mode's direction, or what mu_s w
is larger than its force. The cubic through the gauges and their rates at both ends of a step shows the first
zero, also of two in one step; the step is then made again as long as that, and its length corrected until the
gauge is zero to rounding. While all blocks stick the wait is in closed form.

The compiled step is that of `rk4`: Numba's cache does not see an edit there.
"""

from __future__ import annotations

import math

import numpy as np

from precursors.methods.common import fixed_step
from precursors.methods.forces import (
    ELAPSED,
    EVALUATIONS,
    LAST,
    LEGS_PER_CALL,
    MOVING,
    PAUSED,
    STEPS_IN_LEG,
    apart,
    begin_leg,
    change_mode,
    inner,
    outer,
    rates,
    resting_mode,
    step_length,
)
from precursors.methods.rk4 import new_scratch, rk4_from_rates

STEPS = (6e-6, 4e-6, 3e-6, 2e-6, 1e-6, 6e-7, 3e-7, 1e-7, 3e-8)
# A gauge below so many roundings of the forces is zero.
ROUNDINGS = 8 * float(np.finfo(float).eps)
CORRECTIONS = 8
BISECTIONS = 60
# Transitions closer than this part of a step follow one another without time going on.
IDLE = 1e-12


@inner
def gauge_of(system, state, i):
    """What has to stay positive while block i keeps its mode: velocity [m/s] or margin of mu_s w [N]."""
    if state.mode[i] != 0:
        return state.mode[i] * state.velocity[i]
    return system.strength[i] - abs(state.tension[i] - state.tension[i + 1])


@inner
def gauges(system, state, last, d_tension, d_velocity, value, slope):
    """Gauges of the blocks that can change their state, and their rates."""
    for i in range(1, last + 1):
        value[i] = gauge_of(system, state, i)
        if state.mode[i] != 0:
            slope[i] = state.mode[i] * d_velocity[i]
        else:
            sign = 1.0 if state.tension[i] > state.tension[i + 1] else -1.0
            slope[i] = -sign * (d_tension[i] - d_tension[i + 1])


@inner
def cubic_at(s, g0, b0, g1, b1):
    """Cubic with values g0, g1 and slopes b0, b1 at s = 0 and 1 (Hermite)."""
    r = 1.0 - s
    return r * r * ((1.0 + 2.0 * s) * g0 + s * b0) + s * s * ((1.0 + 2.0 * r) * g1 - r * b1)


@inner
def cubic_slope(s, g0, b0, g1, b1):
    """Slope of `cubic_at`."""
    r = 1.0 - s
    return 6.0 * s * r * (g1 - g0) + r * (1.0 - 3.0 * s) * b0 + s * (1.0 - 3.0 * r) * b1


@apart
def falls_to_zero(low, high, g0, b0, g1, b1):
    """Where the cubic, positive at `low` and negative at `high`, is zero."""
    for _ in range(BISECTIONS):
        middle = 0.5 * (low + high)
        if cubic_at(middle, g0, b0, g1, b1) > 0.0:
            low = middle
        else:
            high = middle
    return high


@apart
def first_zero(g0, b0, g1, b1, rounding):
    """First place in 0 < s <= 1 where the cubic becomes negative by more than a rounding; 2 if none does."""
    g0 = max(g0, 0.0)
    if g0 + b0 / 3.0 >= 0.0 and g1 - b1 / 3.0 >= 0.0 and g1 >= 0.0:
        return 2.0
    # Turning points of the cubic: a s^2 + b s + b0 = 0.
    a = 3.0 * (b0 + b1 - 2.0 * (g1 - g0))
    b = 6.0 * (g1 - g0) - 4.0 * b0 - 2.0 * b1
    lowest = 1.0
    discriminant = b * b - 4.0 * a * b0
    if discriminant > 0.0:
        q = -0.5 * (b + (1.0 if b > 0.0 else -1.0) * math.sqrt(discriminant))
        for turn in (q / a, b0 / q):
            if 0.0 < turn < 1.0 and b + 2.0 * a * turn > 0.0 and cubic_at(turn, g0, b0, g1, b1) < -rounding:
                lowest = turn
    if lowest == 1.0 and g1 >= -rounding:
        return 2.0
    start = 0.0
    if g0 <= rounding and b0 > 0.0:
        # It rises from zero: begin at the top before the fall.
        start = 1.0
        if discriminant > 0.0:
            for turn in (q / a, b0 / q):
                if 0.0 < turn < lowest and b + 2.0 * a * turn < 0.0:
                    start = turn
        if start == 1.0:
            return 2.0
    return falls_to_zero(start, lowest, g0, b0, g1, b1)


@inner
def first_transition(system, state, last, h, before, after):
    """Block that changes its state first in a step, and the part of the step at which it does (2: none)."""
    first, block = 2.0, 0
    force_rounding, velocity_rounding = roundings(system)
    for i in range(1, last + 1):
        rounding = force_rounding if state.mode[i] == 0 else velocity_rounding
        s = first_zero(before[0, i], h * before[1, i], after[0, i], h * after[1, i], rounding)
        if s < first:
            first, block = s, i
    return first, block


@inner
def roundings(system):
    """Rounding of a force [N] and of a velocity [m/s]."""
    force = ROUNDINGS * np.sum(system.strength)
    return force, force * math.sqrt(system.inverse_mass / np.max(system.spring))


@outer
def run_located(system, state, record, clock, count, duration, until_global, step):
    """Run until `duration` [s], the end of the first global slip, a full record or a spent budget."""
    n_blocks = state.mode.shape[0] - 2
    scratch = new_scratch(state)
    start, rate_before, rate_after = scratch[:2].copy(), scratch[:2].copy(), scratch[:2].copy()
    before, after = scratch[:2].copy(), scratch[:2].copy()
    force_rounding, velocity_rounding = roundings(system)
    idle = 0
    for _ in range(LEGS_PER_CALL):
        status = begin_leg(system, state, record, clock, count, duration, until_global, True)
        if status != MOVING:
            return status
        last = count[LAST]
        watched = min(last + 1, n_blocks)
        rates(system, state, last, state.tension, state.velocity, rate_before[0], rate_before[1])
        gauges(system, state, watched, rate_before[0], rate_before[1], before[0], before[1])
        count[EVALUATIONS] += 1
        h, s, i = step, 2.0, 0
        for _ in range(STEPS_IN_LEG):
            h = step_length(clock, duration, step)
            start[0], start[1] = state.tension, state.velocity
            scratch[4], scratch[5] = rate_before[0], rate_before[1]
            rk4_from_rates(system, state, last, h, scratch)
            rates(system, state, last, state.tension, state.velocity, rate_after[0], rate_after[1])
            gauges(system, state, watched, rate_after[0], rate_after[1], after[0], after[1])
            count[EVALUATIONS] += 4
            s, i = first_transition(system, state, watched, h, before, after)
            # Where blocks change without time going on, rounding can decide in a circle: make a whole step.
            if s <= 1.0 and idle <= 4 * n_blocks:
                break
            s = 2.0
            clock[ELAPSED] += h
            rate_before, rate_after = rate_after, rate_before
            before, after = after, before
            idle = 0
            if h < step:
                break
        if s > 1.0:
            continue
        rounding = force_rounding if state.mode[i] == 0 else velocity_rounding
        for correction in range(CORRECTIONS):
            state.tension[:], state.velocity[:] = start[0], start[1]
            scratch[4], scratch[5] = rate_before[0], rate_before[1]
            rk4_from_rates(system, state, last, s * h, scratch)
            count[EVALUATIONS] += 3
            g = gauge_of(system, state, i)
            slope = cubic_slope(s, before[0, i], h * before[1, i], after[0, i], h * after[1, i])
            if abs(g) <= rounding or slope >= 0.0 or correction == CORRECTIONS - 1:
                break
            s = min(max(s - g / slope, 0.0), 1.0)
        idle = idle + 1 if s * h <= IDLE * step else 0
        clock[ELAPSED] += s * h
        if state.mode[i] == 0:
            new = 1 if state.tension[i] > state.tension[i + 1] else -1
        else:
            state.velocity[i] = 0.0
            new = resting_mode(system, state, i)
        if new != state.mode[i]:
            change_mode(system, state, record, clock, count, i, new)
    return PAUSED


METHODS = (fixed_step("rk4_located", "RK4, transitions located", STEPS, run_located),)
