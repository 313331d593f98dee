"""The search of the first root of a watched function, a slot of `Search` each, by steps that pass none."""

from __future__ import annotations

import numpy as np

from precursors.solver.kernel.bounds import cubic_bound, downward, safe_step, surely_positive, turning
from precursors.solver.kernel.compiled import inner, seldom
from precursors.solver.kernel.layout import (
    AT_ROOT,
    BEND,
    FINAL,
    ORIGIN,
    SECOND_DERIVATIVE,
    SPAN,
    STEPS,
    TURN,
    WHOLE,
    ZERO_BELOW,
)


@inner
def examine(slot, count, search):
    """Bound the first root of series[slot] (time in spans) from below.

    A root at the start was dealt with already: it is divided out. Where the function then falls, the
    transition is at once.
    """
    series, level, terms, stage = search.series, search.level, search.terms, search.stage
    p = 0
    while p < count and abs(series[slot, p]) <= level[slot, ZERO_BELOW]:
        p += 1
    if p == count:
        return np.inf
    if series[slot, p] < 0.0:
        stage[slot] = FINAL
        return level[slot, ORIGIN]
    divide_out(slot, p, count, series)
    count = max(count - p, 4)
    c0, c1, c2, c3 = series[slot, 0], series[slot, 1], series[slot, 2], series[slot, 3]
    rest = 0.0
    bend = 0.0
    for n in range(4, count):
        c = abs(series[slot, n])
        rest += c
        bend += SECOND_DERIVATIVE[n] * c
    if surely_positive(c0, c1, c2, c3, rest):
        return np.inf
    terms[slot] = count
    level[slot, BEND] = downward(c2, c3) + bend
    level[slot, TURN] = turning(c2, c3) + bend
    level[slot, STEPS] = 0.0
    stage[slot] = WHOLE
    return level[slot, ORIGIN] + cubic_bound(c0, c1, c2, c3, rest) * level[slot, SPAN]


@inner
def divide_out(slot, p, count, series):
    """Divide series[slot] by s^p; it keeps at least four terms."""
    if p > 0:
        for n in range(count - p):
            series[slot, n] = series[slot, n + p]
        for n in range(count - p, 4):
            series[slot, n] = 0.0


@inner
def refine(slot, t, search):
    """Step from the bound t towards the root of a watched function; it is FINAL once it is the root."""
    series, level, terms, stage = search.series, search.level, search.terms, search.stage
    span = level[slot, SPAN]
    x = (t - level[slot, ORIGIN]) / span
    # Even and odd terms apart, for two short chains of operations instead of a long one.
    y = x * x
    top = (terms[slot] - 1) // 2
    even = series[slot, 2 * top]
    odd = series[slot, 2 * top + 1] if terms[slot] % 2 == 0 else 0.0
    even_slope = 0.0
    odd_slope = 0.0
    for k in range(1, top + 1):
        n = 2 * (top - k)
        even_slope = even_slope * y + even
        odd_slope = odd_slope * y + odd
        even = even * y + series[slot, n]
        odd = odd * y + series[slot, n + 1]
    g = even + x * odd
    slope = odd + 2.0 * x * (even_slope + x * odd_slope)
    if slope < 0.0:
        # Newton's step, where it ends at the root.
        step = max(-g / slope, -1e-9)
        close = AT_ROOT * level[slot, ZERO_BELOW]
        if g <= close or 0.5 * level[slot, TURN] * step * step <= close:
            stage[slot] = FINAL
            return level[slot, ORIGIN] + max(x + step, 0.0) * span
    step = safe_step(max(g, 0.0), slope, level[slot, BEND])
    if g <= level[slot, ZERO_BELOW] or x + step <= x:
        stage[slot] = FINAL
        step = step if slope < 0.0 else 0.0
    return level[slot, ORIGIN] + max(x + step, 0.0) * span


@seldom
def examine_from(slot, t, search):
    """Examine the rest of the window beyond t, which no root lies before, with the series moved there."""
    series, level, terms = search.series, search.level, search.terms
    count = terms[slot]
    x = (t - level[slot, ORIGIN]) / level[slot, SPAN]
    for first in range(count - 1):
        for k in range(count - 1 - first):
            n = count - 2 - k
            series[slot, n] += x * series[slot, n + 1]
    rest = 1.0 - x
    power = 1.0
    for n in range(count):
        series[slot, n] *= power
        power *= rest
    level[slot, ORIGIN] = t
    level[slot, SPAN] *= rest
    if series[slot, 0] <= level[slot, ZERO_BELOW]:
        level[slot, BEND] *= rest * rest
        level[slot, TURN] *= rest * rest
        level[slot, STEPS] = 0.0
        return t
    return examine(slot, terms[slot], search)


@inner
def keep(slot, search):
    """Add a slot to those that may have a root."""
    active = search.active
    active[0] += 1
    active[active[0]] = slot
