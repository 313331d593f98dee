"""Find the first root of a function by safe steps, if the guess could not be proved."""

import math

import numpy as np

from precursors.solver.kernel.arrays import (
    COUPLING,
    RATE,
    SLIDES,
    SPRING_FORCE,
    STRENGTH,
    WHOLE,
)
from precursors.solver.kernel.decorators import inner, seldom
from precursors.solver.kernel.layout import PROOF_ORDER

# After this many steps the polynomial is expanded about the present place, because
# steps are tiny near a flat start.
RESTART = 12


@inner
def zero_below(i, roundings, motion):
    """Return the size below which a force on block i, or the velocity that it causes in
    the window, counts as zero.

    It is proportional to the forces, and to their change by the motion of the block and
    its neighbours within the window.
    """
    springs = abs(motion[SPRING_FORCE, i]) + abs(motion[SPRING_FORCE, i + 1])
    still = springs + motion[STRENGTH, i]
    behind = motion[COUPLING, i] * fastest(i - 1, motion)
    moving = behind + motion[COUPLING, i + 1] * fastest(i + 1, motion)
    return roundings * (2.0 * still + moving + fastest(i, motion))


@inner
def fastest(i, motion):
    """Return the sum of the first terms of block i's speed in the window."""
    total = 0.0
    if motion[SLIDES, i] > 0.0:
        for n in range(PROOF_ORDER + 1):
            total += abs(motion[RATE + n, i]) * motion[WHOLE, n]
    return total


@seldom
def first_root(count, zero, series, progress):
    """Return the first root in [0, 1] of a polynomial with `count` terms, or infinity.

    A value up to `zero` counts as zero. A root at the start belongs to the last
    transition, and is divided out. If the function still falls, there is another one at
    the start. `series` is overwritten.
    """
    resolved = 0
    while resolved < count and abs(series[resolved]) <= zero:
        resolved += 1
    if resolved == count:
        return np.inf
    count -= resolved
    if resolved > 0:
        for n in range(count):
            series[n] = series[n + resolved]
    start = 0.0
    span = 1.0
    while True:
        if series[0] < 0.0:
            return start
        least = series[0]
        curvature = 0.0
        for n in range(1, count):
            least += min(series[n], 0.0)
            curvature -= n * (n - 1.0) * min(series[n], 0.0)
        if least > 0.0:
            return np.inf
        x = 0.0
        for _ in range(RESTART):
            g = slope = 0.0
            for n in range(count - 1, -1, -1):
                slope = slope * x + g
                g = g * x + series[n]
            progress.root_steps += 1
            step = safe_step(max(g, 0.0), slope, curvature)
            if g <= zero or x + step <= x:
                return start + (x + (step if slope < 0.0 else 0.0)) * span
            x += step
            if not x <= 1.0:
                return np.inf
        move_series(x, count, series)
        start = start + x * span
        span = span * (1.0 - x)


@inner
def safe_step(g, slope, curvature):
    """Return the positive root of g + slope s - curvature s^2/2 (g >= 0).

    No root of a function with -g'' <= curvature lies before it.
    """
    root = math.sqrt(slope * slope + 2.0 * curvature * g)
    if slope < 0.0:
        return 2.0 * g / (root - slope)
    return (slope + root) / curvature if curvature > 0.0 else np.inf


@seldom
def move_series(x, count, series):
    """Expand the polynomial about x, and scale it to the rest of [0, 1]."""
    for lowest in range(count - 1):
        for n in range(count - 2, lowest - 1, -1):
            series[n] += x * series[n + 1]
    power = 1.0
    for n in range(count):
        series[n] *= power
        power *= 1.0 - x
