"""The classical Runge-Kutta method with a fixed step, cut where a block changes its state.

An event function of each block is positive while its state lasts: its velocity in its mode's direction,
or what mu_s w is larger than its force. The cubic through the values and rates of this function at both
ends of a step shows the first zero, also of two in one step. The step is then made again as long as that,
and its length corrected until the function is zero to rounding. While all blocks stick the wait is in
closed form."""

from __future__ import annotations

import math

import numpy as np

from precursors.methods.columns import apart, by_mode, inner, outer, rates, resting_mode, rows
from precursors.methods.fixed_step import (
    LEGS_PER_CALL,
    MOVING,
    PAUSED,
    STEPS_IN_LEG,
    begin_leg,
    change_mode,
    fixed_step,
    step_length,
)
from precursors.methods.rk4 import step_from_rates

STEPS = (6e-6, 4e-6, 3e-6, 2e-6, 1e-6, 6e-7, 3e-7, 1e-7, 3e-8)
# An event function below so many roundings of the forces is zero.
ROUNDINGS = 8 * float(np.finfo(float).eps)
CORRECTIONS = 8
BISECTIONS = 60
# Transitions closer than this part of a step follow one another without time going on.
IDLE = 1e-12
NEVER = 2.0  # a part of the step beyond its end


@inner
def event_function(system, state, i):
    """What stays positive while block i keeps its mode: velocity [m/s] or margin of mu_s w [N]."""
    if state.mode[i] != 0:
        return state.mode[i] * state.velocity[i]
    net = state.spring_force[i] - state.spring_force[i + 1]
    return min(system.strength[i] - net, system.backward[i] + net)


@inner
def evaluate(system, state, last, rate, event):
    """Rates of blocks 1..last (rows of `rate`); event functions of all that can change, and their rates."""
    rates(by_mode, 0.0, system, state, last, state.spring_force, state.velocity, rate[0], rate[1])
    for i in range(1, min(last + 1, state.mode.shape[0] - 2) + 1):
        event[0, i] = event_function(system, state, i)
        if state.mode[i] != 0:
            event[1, i] = state.mode[i] * rate[1, i]
        else:
            net = state.spring_force[i] - state.spring_force[i + 1]
            sign = 1.0 if system.strength[i] - net < system.backward[i] + net else -1.0
            event[1, i] = -sign * (rate[0, i] - rate[0, i + 1])


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
    """First place in 0 < s <= 1 where the cubic becomes negative by more than a rounding, or NEVER."""
    g0 = max(g0, 0.0)
    if g0 + b0 / 3.0 >= 0.0 and g1 - b1 / 3.0 >= 0.0 and g1 >= 0.0:
        return NEVER
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
        return NEVER
    start = 0.0
    if g0 <= rounding and b0 > 0.0:
        # It rises from zero: begin at the top before the fall.
        start = 1.0
        if discriminant > 0.0:
            for turn in (q / a, b0 / q):
                if 0.0 < turn < lowest and b + 2.0 * a * turn < 0.0:
                    start = turn
        if start == 1.0:
            return NEVER
    return falls_to_zero(start, lowest, g0, b0, g1, b1)


@inner
def roundings(system):
    """Roundings of the event functions: of a force while a block sticks [N], of a velocity [m/s]."""
    force = ROUNDINGS * np.sum(system.strength)
    return force, force * math.sqrt(system.inverse_mass / np.max(system.spring))


@inner
def first_transition(state, last, h, before, after, rounding):
    """Block that changes its state first in a step, and the part of the step at which it does."""
    first, block = NEVER, 0
    for i in range(1, min(last + 1, state.mode.shape[0] - 2) + 1):
        zero = rounding[0] if state.mode[i] == 0 else rounding[1]
        s = first_zero(before[0, i], h * before[1, i], after[0, i], h * after[1, i], zero)
        if s < first:
            first, block = s, i
    return first, block


@inner
def step_from(motion, start, rate, h, work):
    """Go back to the start of a step, and make one of h [s] instead."""
    state = motion.state
    state.spring_force[:], state.velocity[:] = start[0], start[1]
    work[4], work[5] = rate[0], rate[1]
    step_from_rates(by_mode, 0.0, motion.system, state, motion.progress.last, h, work)


@apart
def change_state(motion, i):
    """Release a block, or let it stop or turn round."""
    state = motion.state
    if state.mode[i] == 0:
        new = 1 if state.spring_force[i] > state.spring_force[i + 1] else -1
    else:
        state.velocity[i] = 0.0
        new = resting_mode(motion.system, state, i)
    if new != state.mode[i]:
        change_mode(motion, i, new)


@outer
def run_located(motion, step):
    """Run until the end, a full record or a spent budget of legs."""
    system, state, progress = motion.system, motion.state, motion.progress
    most_idle, rounding = 4 * (state.mode.shape[0] - 2), roundings(system)
    work = rows(state, 6)
    # At a step's start: the state, its rates, and event functions with theirs; rates and functions at its
    # end.
    start, rate, event = work[:2].copy(), work[:2].copy(), work[:2].copy()
    rate_after, event_after = work[:2].copy(), work[:2].copy()
    idle = 0
    for _ in range(LEGS_PER_CALL):
        status = begin_leg(motion, True)
        if status != MOVING:
            return status
        last = progress.last
        evaluate(system, state, last, rate, event)
        progress.evaluations += 1
        h, s, i = step, NEVER, 0
        for _ in range(STEPS_IN_LEG):
            h = step_length(progress, step)
            start[0], start[1] = state.spring_force, state.velocity
            work[4], work[5] = rate[0], rate[1]
            step_from_rates(by_mode, 0.0, system, state, last, h, work)
            evaluate(system, state, last, rate_after, event_after)
            progress.evaluations += 4
            s, i = first_transition(state, last, h, event, event_after, rounding)
            # Where blocks change without time going on, rounding can decide in a circle: make a whole step.
            if s <= 1.0 and idle <= most_idle:
                break
            s = NEVER
            progress.elapsed += h
            rate, rate_after = rate_after, rate
            event, event_after = event_after, event
            idle = 0
            if h < step:
                break
        if s > 1.0:
            continue
        zero = rounding[0] if state.mode[i] == 0 else rounding[1]
        for correction in range(CORRECTIONS):
            step_from(motion, start, rate, s * h, work)
            progress.evaluations += 3
            g = event_function(system, state, i)
            slope = cubic_slope(s, event[0, i], h * event[1, i], event_after[0, i], h * event_after[1, i])
            if abs(g) <= zero or slope >= 0.0 or correction == CORRECTIONS - 1:
                break
            s = min(max(s - g / slope, 0.0), 1.0)
        idle = idle + 1 if s * h <= IDLE * step else 0
        progress.elapsed += s * h
        change_state(motion, i)
    return PAUSED


METHODS = (
    fixed_step(
        "rk4_located",
        "RK4, transitions located",
        run_located,
        values=STEPS,
        whole=STEPS,
        quick=(3e-6, 1e-6, 6e-7, 3e-7, 1e-7),
        quick_whole=(1e-6, 1e-7, 3e-8),
        kind="located",
        color="#63C9A8",
        marker="d",
    ),
)
