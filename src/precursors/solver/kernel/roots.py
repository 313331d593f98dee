"""The search of the first root of a watched function, a slot of `Search` each, by steps that pass none."""

from __future__ import annotations

import numpy as np

from precursors.solver.kernel.bounds import cubic_bound, downward, safe_step, surely_positive, turning
from precursors.solver.kernel.compiled import FOUR, ONE, THREE, TWO, ZERO, index, inner, seldom
from precursors.solver.kernel.layout import (
    BEND,
    DOUBT,
    FINAL,
    ORIGIN,
    SECOND_DERIVATIVE,
    SPAN,
    STEPS,
    TURN,
    WHOLE,
)


@inner
def examine(slot, count, search):
    """Bound the first root of series[slot] (time in spans) from below.

    A root at the start was dealt with already: it is divided out. Where the function then falls, the
    transition is at once.
    """
    series, level, terms, stage = search.series, search.level, search.terms, search.stage
    row = index(slot)
    count = index(count)
    p = ZERO
    while p < count and abs(series[row, p]) <= level[slot, DOUBT]:
        p += ONE
    if p == count:
        return np.inf
    if series[row, p] < 0.0:
        stage[slot] = FINAL
        return level[slot, ORIGIN]
    divide_out(row, p, count, series)
    count = max(count - p, FOUR)
    c0, c1, c2, c3 = series[row, ZERO], series[row, ONE], series[row, TWO], series[row, THREE]
    rest = 0.0
    bend = 0.0
    for n in range(FOUR, count):
        c = abs(series[row, n])
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
def divide_out(row, p, count, series):
    """Divide series[row] by s^p; it keeps at least four terms."""
    if p > ZERO:
        for n in range(count - p):
            series[row, n] = series[row, n + p]
        for n in range(count - p, FOUR):
            series[row, n] = 0.0


@inner
def refine(slot, t, search):
    """Step from the bound t towards the root of a watched function; it is FINAL once it is the root."""
    series, level, terms, stage = search.series, search.level, search.terms, search.stage
    row = index(slot)
    span = level[slot, SPAN]
    x = (t - level[slot, ORIGIN]) / span
    # Even and odd terms apart, for two short chains of operations instead of a long one.
    y = x * x
    top = index(terms[slot] - 1) // TWO
    even = series[row, TWO * top]
    odd = series[row, TWO * top + ONE] if terms[slot] % 2 == 0 else 0.0
    even_slope = 0.0
    odd_slope = 0.0
    for k in range(ONE, top + ONE):
        n = TWO * (top - k)
        even_slope = even_slope * y + even
        odd_slope = odd_slope * y + odd
        even = even * y + series[row, n]
        odd = odd * y + series[row, n + ONE]
    g = even + x * odd
    slope = odd + 2.0 * x * (even_slope + x * odd_slope)
    if slope < 0.0:
        # Newton's step, where it ends so near to the root that the value there counts as zero.
        step = max(-g / slope, -1e-9)
        if g <= level[slot, DOUBT] or 0.5 * level[slot, TURN] * step * step <= level[slot, DOUBT]:
            stage[slot] = FINAL
            return level[slot, ORIGIN] + max(x + step, 0.0) * span
    step = safe_step(max(g, 0.0), slope, level[slot, BEND])
    if g <= level[slot, DOUBT] or x + step <= x:
        stage[slot] = FINAL
        step = 0.0
    return level[slot, ORIGIN] + max(x + step, 0.0) * span


@seldom
def examine_from(slot, t, search):
    """Examine the rest of the window beyond t, which no root lies before, with the series moved there."""
    series, level, terms, stage = search.series, search.level, search.terms, search.stage
    row = index(slot)
    count = index(terms[slot])
    x = (t - level[slot, ORIGIN]) / level[slot, SPAN]
    for first in range(count - ONE):
        for k in range(count - ONE - first):
            n = count - TWO - k
            series[row, n] += x * series[row, n + ONE]
    rest = 1.0 - x
    power = 1.0
    for n in range(count):
        series[row, n] *= power
        power *= rest
    level[slot, ORIGIN] = t
    level[slot, SPAN] *= rest
    if series[row, ZERO] <= level[slot, DOUBT]:
        stage[slot] = FINAL
        return t
    return examine(slot, terms[slot], search)


@inner
def keep(slot, search):
    """Add a slot to those that may have a root."""
    active = search.active
    active[0] += 1
    active[active[0]] = slot
