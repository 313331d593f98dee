"""The next transition: bounds for all blocks, and the earliest root of all."""

from __future__ import annotations

from precursors.solver.kernel import lanes
from precursors.solver.kernel.bounds import (
    cubic_bound,
    downward,
    safe_step,
    surely_positive,
    turning,
    zero_below,
)
from precursors.solver.kernel.compiled import inner
from precursors.solver.kernel.layout import (
    BEND,
    BUILT,
    C0,
    C1,
    C2,
    C3,
    CUBIC,
    FINAL,
    INVERSE_FACTORIAL,
    ORDER,
    ORIGIN,
    POWER,
    REACH_SQUARED,
    REST,
    RESTART,
    ROOT_STEPS,
    ROUGH,
    SPAN,
    STEPS,
    TAIL,
    TURN,
    WHOLE,
    ZERO_BELOW,
)
from precursors.solver.kernel.margins import margin_series, may_let_go, watch_margins
from precursors.solver.kernel.roots import divide_out, examine, examine_from, keep, refine
from precursors.solver.kernel.series import powers


@inner
def watch(window, chain, motion, search):
    """Bound the next transition of blocks first..last from below, as times in the window.

    Slot 2 i watches the velocity of block i while it slides, or its margin against letting go forward while
    it sticks; slot 2 i + 1 its margin against letting go backward. active[1:active[0] + 1] are the slots that
    may have a root.
    """
    first, final, active, mode = window.first, window.final, search.active, motion.mode
    last = min(final, window.last)
    kept = 0
    for k in range(1, active[0] + 1):
        if active[k] < 2 * first or active[k] > 2 * final + 1:
            kept += 1
            active[kept] = active[k]
    active[0] = kept
    tails = tail_bounds(window, motion.rate)
    for group in range(first, final + 1, 4):
        motion.suspects[group] = may_stop(group, tails[0], motion)
    for group in range(first, final + 1, 4):
        bits = motion.suspects[group] | may_let_go(group, window.span, chain, motion)
        i = group
        while bits != 0 and i <= last:
            if bits & 1:
                zero = zero_below(i, window.roundings, chain, motion)
                if mode[i] != 0:
                    watch_velocity(i, window, mode[i], zero, tails, motion, search)
                else:
                    watch_margins(i, window, zero, tails, chain, motion, search)
            bits >>= 1
            i += 1


@inner
def may_stop(i, tail, motion):
    """Bits of those of blocks i..i + 3 that slide and may stop in the window; `fastest` is set for all four.

    The test is that of `surely_positive`, with the size of each term from the fourth on and the tail as rest.
    """
    sense, rate, weight, fastest = motion.sense, motion.rate, motion.weight, motion.fastest
    sign = lanes.load(sense, i)
    slides = sign * sign
    c0 = sign * lanes.load_row(rate, 0, i)
    c1 = sign * (lanes.load_row(rate, 1, i) * weight[1])
    c2 = sign * (lanes.load_row(rate, 2, i) * weight[2])
    c3 = sign * (lanes.load_row(rate, 3, i) * weight[3])
    rest = (size(4, i, rate, weight) + size(5, i, rate, weight)) + (
        size(6, i, rate, weight) + size(7, i, rate, weight)
    )
    rest = rest + tail
    total = (lanes.magnitude(c0) + lanes.magnitude(c1)) + (lanes.magnitude(c2) + lanes.magnitude(c3)) + rest
    lanes.store(fastest, i, total * slides)
    zero = lanes.spread(0.0)
    least = (c0 + lanes.smaller(c1, zero)) + (lanes.smaller(c2, zero) + lanes.smaller(c3, zero))
    return lanes.where_not_above(least, slides * rest - (1.0 - slides))


@inner
def size(n, i, rate, weight):
    """Largest value of term n of the series of blocks i..i + 3 in the window."""
    return lanes.magnitude(lanes.load_row(rate, n, i)) * weight[n]


@inner
def watch_velocity(i, window, sign, zero, tails, motion, search):
    """Bound the time at which sliding block i stops from below; `tails` bounds the rest of its series."""
    rate, weight, origin, span = motion.rate, motion.weight, window.origin, window.span
    series, level, stage, bound = search.series, search.level, search.stage, search.bound
    tail, tail_bend = tails
    slot = 2 * i
    w1, w2, w3, w4 = weight[1], weight[2], weight[3], weight[4]
    c0, c1 = sign * rate[0, i], sign * rate[1, i] * w1
    c2, c3 = sign * rate[2, i] * w2, sign * rate[3, i] * w3
    r4, r5 = abs(rate[4, i]) * w4, abs(rate[5, i]) * weight[5]
    r6, r7 = abs(rate[6, i]) * weight[6], abs(rate[7, i]) * weight[7]
    rest = (r4 + r5) + (r6 + r7) + tail
    level[slot, ORIGIN], level[slot, SPAN], level[slot, ZERO_BELOW] = origin, span, zero
    if c0 > zero:
        level[slot, POWER] = 0.0
        bend = 12.0 * r4 + 20.0 * r5 + 30.0 * r6 + 42.0 * r7 + tail_bend
    elif c0 >= -zero and c1 > zero:
        # It has just begun to move: the root at the start is divided out.
        c0, c1, c2, c3 = c1, c2, c3, sign * rate[4, i] * w4
        rest = r5 + r6 + r7 + tail
        if surely_positive(c0, c1, c2, c3, rest):
            return
        level[slot, POWER] = 1.0
        bend = 12.0 * r5 + 20.0 * r6 + 30.0 * r7 + tail_bend
    else:
        for n in range(ORDER + 1):
            series[slot, n] = sign * rate[n, i] * weight[n]
        stage[slot], bound[slot] = BUILT, origin
        keep(slot, search)
        return
    level[slot, BEND], level[slot, TURN] = downward(c2, c3) + bend, turning(c2, c3) + bend
    level[slot, C0], level[slot, C1], level[slot, C2], level[slot, C3] = c0, c1, c2, c3
    level[slot, REST] = rest
    stage[slot] = ROUGH
    bound[slot] = origin + safe_step(c0, c1, downward(c2, c3) + 12.0 * rest) * span
    if bound[slot] < origin + span:
        keep(slot, search)


@inner
def next_transition(window, chain, motion, search, count):
    """Earliest root of all watched functions: (time in the window, slot); (limit, -1) where there is none."""
    level, stage, bound, active = search.level, search.stage, search.bound, search.active
    while True:
        slot, t = -1, window.limit
        for k in range(1, active[0] + 1):
            if bound[active[k]] < t:
                slot, t = active[k], bound[active[k]]
        if slot < 0 or stage[slot] == FINAL:
            return t, slot
        if stage[slot] == BUILT:
            bound[slot] = examine(slot, ORDER + 1, search)
            continue
        if stage[slot] == ROUGH:
            s = cubic_bound(
                level[slot, C0], level[slot, C1], level[slot, C2], level[slot, C3], level[slot, REST]
            )
            bound[slot] = level[slot, ORIGIN] + s * level[slot, SPAN]
            stage[slot] = CUBIC
            continue
        if stage[slot] == CUBIC:
            build(slot, window, chain, motion, search)
        count[ROOT_STEPS] += 1
        level[slot, STEPS] += 1.0
        if level[slot, STEPS] > RESTART:
            bound[slot] = examine_from(slot, t, search)
        else:
            bound[slot] = refine(slot, t, search)


@inner
def build(slot, window, chain, motion, search):
    """Fill the whole series of a watched function, a root at its start divided out."""
    series, level = search.series, search.level
    i = slot // 2
    mode, rate, weight = motion.mode[i], motion.rate, motion.weight
    if mode == 0:
        margin_series(slot, i, chain, motion, series)
    else:
        if level[slot, ORIGIN] != window.origin:
            weight = motion.spare
            powers(level[slot, SPAN], weight)
        for n in range(ORDER + 1):
            series[slot, n] = mode * rate[n, i] * weight[n]
    p = int(level[slot, POWER])
    divide_out(slot, p, ORDER + 1, series)
    search.terms[slot] = ORDER + 1 - p
    level[slot, STEPS] = 0.0
    search.stage[slot] = WHOLE


@inner
def tail_bounds(window, rate):
    """Bounds of the terms from the eighth on of the velocity series of blocks first..final: sum, curvature.

    Row n + 2 of a block is at most REACH^2 times the largest of row n (Gershgorin); moving neighbours
    outside, in columns first - 1 and final + 1, enter with all their rows, which follow from others.
    """
    first, final, span = window.first, window.final, window.span
    sixth_row = seventh_row = lanes.spread(0.0)
    for i in range(first, final + 1, 4):
        sixth_row = lanes.larger(sixth_row, lanes.magnitude(lanes.load_row(rate, 6, i)))
        seventh_row = lanes.larger(seventh_row, lanes.magnitude(lanes.load_row(rate, 7, i)))
    even = max(lanes.largest(sixth_row), abs(rate[6, first - 1]), abs(rate[6, final + 1]))
    odd = max(lanes.largest(seventh_row), abs(rate[7, first - 1]), abs(rate[7, final + 1]))
    if first > 1 or final < window.end:
        shrink = 1.0
        for n in range(8, ORDER + 1):
            if n % 2 == 0:
                shrink /= REACH_SQUARED
                even = max(even, shrink * abs(rate[n, first - 1]), shrink * abs(rate[n, final + 1]))
            else:
                odd = max(odd, shrink * abs(rate[n, first - 1]), shrink * abs(rate[n, final + 1]))
    # Each of the two sums is geometric at worst.
    square = span * span
    sixth = REACH_SQUARED * TAIL * square * square * square
    value = sixth * square * (even * INVERSE_FACTORIAL[8] + odd * span * INVERSE_FACTORIAL[9])
    return value, sixth * square * (even * INVERSE_FACTORIAL[6] + odd * span * INVERSE_FACTORIAL[7])
