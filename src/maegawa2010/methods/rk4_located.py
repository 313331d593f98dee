"""The classical Runge-Kutta method with a fixed step, cut where a block changes its
state.

An event function of each block is positive while its state lasts: its velocity in its
mode's direction, or what mu_s w is larger than its force. The cubic through the values
and rates of this function at both ends of a step shows the first zero, also of two in
one step. The step is then made again as long as that, and its length corrected until
the function is zero to rounding. While all blocks stick the wait is in closed form."""

from __future__ import annotations

import math

import numpy as np

from maegawa2010.methods.columns import (
    BACKWARD,
    INVERSE_MASS,
    MODE,
    SPRING,
    STRENGTH,
    VELOCITY,
)
from maegawa2010.methods.compiled import apart, inner, outer
from maegawa2010.methods.equations import (
    by_mode,
    copy,
    event_function,
    net_force,
    rates,
)
from maegawa2010.methods.fixed_step import (
    STEPS_IN_LEG,
    begin_leg,
    change_state,
    feels,
    step_length,
)
from maegawa2010.methods.march import fixed_step
from maegawa2010.methods.rk4 import room, step_from_rates

# An event function below so many roundings of the forces is zero.
ROUNDINGS = 8 * float(np.finfo(float).eps)
CORRECTIONS = 8
BISECTIONS = 60
# Transitions closer than this part of a step follow one another without time going on.
IDLE = 1e-12
NEVER = 2.0  # a part of the step beyond its end


@inner
def evaluate(system, state, y, last, rate, event):
    """Rates of blocks 1..last in a state y; event functions of all that can change, and
    their rates (rows of `event`)."""
    rates(by_mode, system, state, last, y, rate)
    for i in range(1, feels(state, last) + 1):
        event[0, i] = event_function(system, state, y, i)
        if state[MODE, i] != 0.0:
            event[1, i] = state[MODE, i] * rate[VELOCITY, i]
        else:
            net = net_force(y, i)
            growth = net_force(rate, i)
            is_forward = system[STRENGTH, i] - net < system[BACKWARD, i] + net
            event[1, i] = -growth if is_forward else growth


@inner
def cubic_at(s, g0, b0, g1, b1):
    """Cubic with values g0, g1 and slopes b0, b1 at s = 0 and 1 (Hermite)."""
    r = 1.0 - s
    return r * r * ((1.0 + 2.0 * s) * g0 + s * b0) + s * s * (
        (1.0 + 2.0 * r) * g1 - r * b1
    )


@inner
def cubic_slope(s, g0, b0, g1, b1):
    """Slope of `cubic_at`."""
    r = 1.0 - s
    return 6.0 * s * r * (g1 - g0) + r * (1.0 - 3.0 * s) * b0 + s * (1.0 - 3.0 * r) * b1


@apart
def first_zero(g0, b0, g1, b1, rounding):
    """First place in 0 < s <= 1 where the cubic becomes negative by more than a
    rounding, or NEVER."""
    g0 = max(g0, 0.0)
    if g0 + b0 / 3.0 >= 0.0 and g1 - b1 / 3.0 >= 0.0 and g1 >= 0.0:
        return NEVER
    # Turning points of the cubic: a s^2 + b s + b0 = 0.
    a = 3.0 * (b0 + b1 - 2.0 * (g1 - g0))
    b = 6.0 * (g1 - g0) - 4.0 * b0 - 2.0 * b1
    lowest = 1.0
    top = 0.0
    discriminant = b * b - 4.0 * a * b0
    if discriminant > 0.0:
        q = -0.5 * (b + math.copysign(math.sqrt(discriminant), b))
        bottom, top = (b0 / q, q / a) if q < 0.0 else (q / a, b0 / q)
        if 0.0 < bottom < 1.0 and cubic_at(bottom, g0, b0, g1, b1) < -rounding:
            lowest = bottom
    if lowest == 1.0 and g1 >= -rounding:
        return NEVER
    start = 0.0
    if g0 <= rounding and b0 > 0.0:
        # It rises from zero: begin at the top before the fall.
        if not 0.0 < top < lowest:
            return NEVER
        start = top
    # The cubic is positive at the start and negative at its lowest.
    for _ in range(BISECTIONS):
        middle = 0.5 * (start + lowest)
        if cubic_at(middle, g0, b0, g1, b1) > 0.0:
            start = middle
        else:
            lowest = middle
    return lowest


@inner
def first_transition(state, last, h, before, after, rounding):
    """Block that changes its state first in a step, and the part of the step at which
    it does."""
    first = NEVER
    block = 0
    for i in range(1, feels(state, last) + 1):
        zero = rounding[int(state[MODE, i] != 0.0)]
        s = first_zero(
            before[0, i], h * before[1, i], after[0, i], h * after[1, i], zero
        )
        if s < first:
            first = s
            block = i
    return first, block


@inner
def shorten_step(motion, last, h, s, i, at_start, at_end, zero, work):
    """Correct the part s of a step h [s] until the event function of block i is zero at
    its end."""
    system = motion.system
    state = motion.state
    end = work[2]
    for correction in range(1, CORRECTIONS + 1):
        step_from_rates(by_mode, system, state, last, s * h, work)
        motion.progress[0].evaluations += 3
        g = event_function(system, state, end, i)
        slope = cubic_slope(
            s, at_start[0, i], h * at_start[1, i], at_end[0, i], h * at_end[1, i]
        )
        if abs(g) <= zero or slope >= 0.0 or correction == CORRECTIONS:
            break
        s = min(max(s - g / slope, 0.0), 1.0)
    return s


@outer
def run_located(motion, step):
    """Run in steps that end where a block changes its state."""
    system = motion.system
    state = motion.state
    progress = motion.progress[0]
    # Roundings of the event functions: of a force while a block sticks [N], of a
    # velocity [m/s].
    force = ROUNDINGS * system[STRENGTH].sum()
    velocity = force * math.sqrt(system[INVERSE_MASS, 1] / system[SPRING].max())
    rounding = force, velocity
    rate, trial, end = room(state)
    # Rates at the end of a step; event functions with their rates at both its ends.
    rate_after = np.zeros_like(rate)
    event = np.zeros_like(rate)
    event_after = np.zeros_like(rate)
    idle = 0
    while begin_leg(motion):
        last = progress.last
        copy(state, feels(state, last), end)
        evaluate(system, state, state, last, rate, event)
        progress.evaluations += 1
        for _ in range(STEPS_IN_LEG):
            h = step_length(progress, step)
            work = rate, trial, end
            step_from_rates(by_mode, system, state, last, h, work)
            evaluate(system, state, end, last, rate_after, event_after)
            progress.evaluations += 4
            s, i = first_transition(state, last, h, event, event_after, rounding)
            # Where blocks change without time going on, rounding can decide in a
            # circle: make a whole step.
            if s <= 1.0 and idle <= state.size:
                zero = rounding[int(state[MODE, i] != 0.0)]
                s = shorten_step(motion, last, h, s, i, event, event_after, zero, work)
                idle = idle + 1 if s * h <= IDLE * step else 0
                progress.elapsed += s * h
                copy(end, last, state)
                change_state(motion, i)
                break
            progress.elapsed += h
            copy(end, last, state)
            rate, rate_after = rate_after, rate
            event, event_after = event_after, event
            idle = 0
            if h < step:
                break


METHODS = (fixed_step("rk4_located", run_located),)
