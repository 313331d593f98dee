"""The classical Runge-Kutta method, with transitions at the end of a step or located
within it (W. Kutta, Z. Math. Phys. 46, 1901, 435-453).

`rk4` makes transitions at the end of a step. `rk4_located` ends a step where the first
event function becomes zero. The state is interpolated by the cubic through its values and
rates at both ends of the step, so an event function is a cubic too, and `cubic_root`
gives its first root even if a second one is close.
"""

import math

import numpy as np

from maegawa2010.methods.columns import MODE, STRENGTH, VELOCITY
from maegawa2010.methods.compiled import apart, inner, outer
from maegawa2010.methods.equations import by_mode, copy, net_force, rates
from maegawa2010.methods.fixed_step import (
    STEPS_IN_LEG,
    begin_leg,
    feels,
    run_in_steps,
    step_length,
    switch,
)
from maegawa2010.methods.march import fixed_step

LIMIT = 2.0 * math.sqrt(2.0)  # largest stable omega dt
STAGES = 4
WEIGHTS = np.array([1.0, 2.0, 2.0, 1.0]) / 6.0
# Search for a root: the step below which it ends, and the largest number of steps.
CLOSE = 1e-15
SEARCHES = 200
NEVER = 2.0  # a fraction of the step that lies beyond its end: no root


def energy_factor(z: float) -> float:
    """Factor on the energy of a mode in a step, z = omega dt, from exp(i z) up to z^4."""
    return abs(1.0 + 1j * z - z**2 / 2.0 - 1j * z**3 / 6.0 + z**4 / 24.0) ** 2


@inner
def mean_slope(k, row, i):
    """Weighted mean of the rates of the four stages of a step."""
    mean = 0.0
    for stage in range(STAGES):
        mean += WEIGHTS[stage] * k[stage, row, i]
    return mean


@inner
def end_of_step(friction, system, state, last, h, k, end):
    """Compute the state at the end of a step, and the rates k[1] to k[3] of its stages
    from k[0]."""
    for stage in range(1, STAGES):
        part = h if stage == STAGES - 1 else 0.5 * h
        for row in range(2):
            for i in range(last + 2):
                end[row, i] = state[row, i] + part * k[stage - 1, row, i]
        rates(friction, system, state, last, end, k[stage])
    for row in range(2):
        for i in range(last + 2):
            end[row, i] = state[row, i] + h * mean_slope(k, row, i)


@inner
def rk4_step(friction, system, state, last, h, work):
    """Make a step of blocks 1..last under a friction law (see `equations.rates`)."""
    rates(friction, system, state, last, state, work[0])
    end_of_step(friction, system, state, last, h, work, work[STAGES])
    copy(work[STAGES], last, state)


@inner
def rk4_by_mode(system, state, last, h, work):
    """Make a step of blocks 1..last; return the number of evaluations."""
    rk4_step(by_mode, system, state, last, h, work)
    return STAGES


@outer
def run_rk4(motion, step):
    """Run with a step [s] (see `run_in_steps`)."""
    work = np.zeros((STAGES + 1, 2, motion.state.shape[1]))
    run_in_steps(motion, step, rk4_by_mode, 0, work)


# Located transitions


@apart
def cubic_root(c, limit):
    """First root of g = c[0] + c[1] x + c[2] x^2 + c[3] x^3 in 0 <= x < limit <= 1, or
    NEVER; c[0] >= 0.

    If |g''| <= M, the positive root of g + g' s - M s^2 / 2 is a step that cannot pass a
    root of g.
    """
    if c[0] + min(c[1], 0.0) + min(c[2], 0.0) + min(c[3], 0.0) > 0.0:
        return NEVER
    curvature = 2.0 * abs(c[2]) + 6.0 * abs(c[3])
    x = 0.0
    for _ in range(SEARCHES):
        g = max(c[0] + x * (c[1] + x * (c[2] + x * c[3])), 0.0)
        slope = c[1] + x * (2.0 * c[2] + 3.0 * x * c[3])
        root = math.sqrt(slope * slope + 2.0 * curvature * g)
        step = 2.0 * g / (root - slope) if slope < 0.0 else (slope + root) / curvature
        if step <= CLOSE:
            return x
        x += step
        if not x < limit:
            return NEVER
    return x


@inner
def interpolate(last, h, k, path):
    """Coefficients of x, x^2 and x^3 in the change of the state up to the fraction x of a
    step; the rates at its end are k[STAGES]."""
    for row in range(2):
        for i in range(1, last + 2):
            start = h * k[0, row, i]
            end = h * k[STAGES, row, i]
            change = h * mean_slope(k, row, i)
            path[0, row, i] = start
            path[1, row, i] = 3.0 * change - 2.0 * start - end
            path[2, row, i] = start + end - 2.0 * change


@inner
def first_event(system, state, last, path, c):
    """Fraction of a step at which the first transition occurs, and its block (0: none)."""
    first = 1.0
    block = 0
    for i in range(1, feels(state, last) + 1):
        mode = state[MODE, i]
        for side in (1.0, -1.0):
            if mode == 0.0:
                c[0] = system[STRENGTH, i] - side * net_force(state, i)
                for n in range(3):
                    c[n + 1] = -side * net_force(path[n], i)
            elif side > 0.0:
                c[0] = mode * state[VELOCITY, i]
                for n in range(3):
                    c[n + 1] = mode * path[n, VELOCITY, i]
            else:
                continue
            x = cubic_root(c, first)
            if x < first:
                first = x
                block = i
    return first, block


@inner
def go_to(x, state, last, path):
    """Advance the state to the fraction x of a step."""
    for row in range(2):
        for i in range(1, last + 2):
            state[row, i] += x * (
                path[0, row, i] + x * (path[1, row, i] + x * path[2, row, i])
            )


@outer
def run_rk4_located(motion, step):
    """Run with a step [s], and locate each transition within its step."""
    system = motion.system
    state = motion.state
    progress = motion.progress[0]
    k = np.zeros((STAGES + 1, 2, state.shape[1]))
    end = np.zeros_like(k[0])
    c = np.zeros(4)
    while begin_leg(motion):
        last = progress.last
        path = np.zeros((3, 2, state.shape[1]))
        rates(by_mode, system, state, last, state, k[0])
        progress.evaluations += 1
        block = 0
        for _ in range(STEPS_IN_LEG):
            h = step_length(progress, step)
            end_of_step(by_mode, system, state, last, h, k, end)
            rates(by_mode, system, state, last, end, k[STAGES])
            progress.evaluations += STAGES
            x = 1.0
            # If modes change again and again without time advancing, rounding decides the
            # event: make a whole step instead.
            if progress.at_once <= state.size:
                interpolate(last, h, k, path)
                x, block = first_event(system, state, last, path, c)
            progress.elapsed += x * h
            if block > 0:
                go_to(x, state, last, path)
                break
            copy(end, last, state)
            copy(k[STAGES], last, k[0])
            if h < step:
                break
        switch(motion, block)


METHODS = (
    fixed_step("rk4", run_rk4, smooth=(LIMIT, energy_factor)),
    fixed_step("rk4_located", run_rk4_located),
)
