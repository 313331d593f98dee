"""Margins mu_s w_i -+ F_i (Eq. 5) of blocks that stick: which may vanish in a window, and when."""

from __future__ import annotations

from precursors.solver.kernel import lanes
from precursors.solver.kernel.bounds import downward, safe_step, surely_positive, turning
from precursors.solver.kernel.compiled import FIVE, FOUR, ONE, SEVEN, SIX, THREE, TWO, ZERO, index, inner
from precursors.solver.kernel.layout import (
    BEND,
    BUILT,
    C0,
    C1,
    C2,
    C3,
    DOUBT,
    ORIGIN,
    POWER,
    REST,
    ROUGH,
    SPAN,
    TURN,
)
from precursors.solver.kernel.roots import keep


@inner
def margin_series(slot, i, order, chain, additions, tension, motion, search):
    """Series of the margin of stuck block i against letting go forward (even slot) or backward (odd slot)."""
    coupling, strength = chain.coupling, chain.strength
    rate, weight, series = motion.rate, motion.weight, search.series
    row, i = index(slot), index(i)
    side = 1.0 - 2.0 * (row % TWO)
    if additions is not None:
        linked_margin_series(row, i, side, order, chain, additions, tension, motion, series)
        return
    b, a = coupling[i], coupling[i + ONE]
    series[row, ZERO] = strength[i] - side * (tension[i] - tension[i + ONE])
    for n in range(ONE, index(order) + ONE):
        growth = b * rate[n - ONE, i - ONE] + a * rate[n - ONE, i + ONE]
        series[row, n] = -side * growth * weight[n]


@inner
def linked_margin_series(row, i, side, order, chain, additions, tension, motion, series):
    """Do what `margin_series` does, with dashpots or interface springs."""
    coupling, strength = chain.coupling, chain.strength
    rate, weight = motion.rate, motion.weight
    b, a, near, far = coupling[i], coupling[i + ONE], i - ONE, i + ONE
    d, c = additions.dashpot[i], additions.dashpot[i + ONE]
    if additions.anchor[i] > 0.0:
        series[row, ZERO] = strength[i] - side * additions.grip[i]
        for n in range(ONE, index(order) + ONE):
            series[row, n] = -side * additions.anchor[i] * rate[n - ONE, i] * weight[n]
    else:
        net = tension[i] - tension[far] + d * rate[ZERO, near] + c * rate[ZERO, far]
        series[row, ZERO] = strength[i] - side * net
        for n in range(ONE, index(order) + ONE):
            growth = b * rate[n - ONE, near] + a * rate[n - ONE, far] + d * rate[n, near] + c * rate[n, far]
            series[row, n] = -side * growth * weight[n]


@inner
def may_let_go(i, span, chain, additions, tension, motion):
    """Bits of those of blocks i..i + 3 that stick and may let go in the window."""
    coupling, strength = chain.coupling, chain.strength
    sense, fastest = motion.sense, motion.fastest
    slides = lanes.load(sense, i) * lanes.load(sense, i)
    still = 1.0 - slides
    if additions is not None:
        return linked_may_let_go(i, span, slides, chain, additions, tension, fastest)
    net = lanes.magnitude(lanes.load(tension, i) - lanes.load(tension, i + ONE))
    change = lanes.load(coupling, i) * lanes.load(fastest, i - ONE)
    change = (change + lanes.load(coupling, i + ONE) * lanes.load(fastest, i + ONE)) * span
    return lanes.where_not_above(still * (lanes.load(strength, i) - net), still * change - slides)


@inner
def linked_may_let_go(i, span, slides, chain, additions, tension, fastest):
    """Do what `may_let_go` does, with dashpots or interface springs."""
    coupling, strength = chain.coupling, chain.strength
    still = 1.0 - slides
    if additions.anchor[ONE] > 0.0:
        change = lanes.load(additions.anchor, i) * lanes.load(fastest, i) * span
        force = lanes.magnitude(lanes.load(additions.grip, i))
    else:
        near, far = lanes.load(fastest, i - ONE), lanes.load(fastest, i + ONE)
        change = (lanes.load(coupling, i) * near + lanes.load(coupling, i + ONE) * far) * span
        # Both what the dashpots hold now and what they come to hold.
        change = change + (
            lanes.load(additions.dashpot, i) * near + lanes.load(additions.dashpot, i + ONE) * far
        )
        force = lanes.magnitude(lanes.load(tension, i) - lanes.load(tension, i + ONE))
    return lanes.where_not_above(still * (lanes.load(strength, i) - force), still * change - slides)


@inner
def watch_margins(i, window, zero, tail, tail_bend, chain, additions, tension, motion, search):
    """Bound the times at which stuck block i lets go forward or backward from below."""
    coupling, strength = chain.coupling, chain.strength
    rate, weight, fastest = motion.rate, motion.weight, motion.fastest
    level, stage, bound = search.level, search.stage, search.bound
    origin, span = window.origin, window.span
    near, far = i - ONE, i + ONE
    b, a = coupling[i], coupling[far]
    if additions is None:
        if b * fastest[near] + a * fastest[far] == 0.0:
            return
        net = tension[i] - tension[far]
        # The net force grows with the velocities of the neighbours.
        g1 = (b * rate[ZERO, near] + a * rate[ZERO, far]) * weight[1]
        g2 = (b * rate[ONE, near] + a * rate[ONE, far]) * weight[2]
        g3 = (b * rate[TWO, near] + a * rate[TWO, far]) * weight[3]
        r4 = abs(b * rate[THREE, near] + a * rate[THREE, far]) * weight[4]
        r5 = abs(b * rate[FOUR, near] + a * rate[FOUR, far]) * weight[5]
        r6 = abs(b * rate[FIVE, near] + a * rate[FIVE, far]) * weight[6]
        r7 = abs(b * rate[SIX, near] + a * rate[SIX, far]) * weight[7]
        r8 = abs(b * rate[SEVEN, near] + a * rate[SEVEN, far]) * weight[8]
        rest = (r4 + r5) + (r6 + r7) + (r8 + (a + b) * tail * span / 9.0)
    else:
        net, g1, g2, g3, r4, r5, r6, r7, r8, rest, bend_beyond = linked_growth(
            i, span, tail, tail_bend, chain.coupling, additions, tension, motion
        )
    for k in range(TWO):
        side = 1.0 - 2.0 * k
        c0, c1, c2, c3 = strength[i] - side * net, -side * g1, -side * g2, -side * g3
        if surely_positive(c0, c1, c2, c3, rest):
            continue
        slot = TWO * i + k
        level[slot, ORIGIN], level[slot, SPAN], level[slot, DOUBT] = origin, span, zero
        if c0 > zero and not window.is_long:
            level[slot, POWER] = 0.0
            bend = 12.0 * r4 + 20.0 * r5 + 30.0 * r6 + 42.0 * r7 + 56.0 * r8
            if additions is None:
                bend += (a + b) * tail_bend * span / 7.0
            else:
                bend += bend_beyond
            level[slot, BEND], level[slot, TURN] = downward(c2, c3) + bend, turning(c2, c3) + bend
            level[slot, C0], level[slot, C1], level[slot, C2], level[slot, C3] = c0, c1, c2, c3
            level[slot, REST] = rest
            stage[slot] = ROUGH
            bound[slot] = origin + safe_step(c0, c1, downward(c2, c3) + 12.0 * rest) * span
        else:
            # The series of the neighbours may get other origins before this one is looked at again.
            margin_series(slot, i, window.order, chain, additions, tension, motion, search)
            stage[slot], bound[slot] = BUILT, origin
        if bound[slot] < origin + span:
            keep(slot, search)


@inner
def linked_growth(i, span, tail, tail_bend, coupling, additions, tension, motion):
    """Force on stuck block i, terms 1 to 3 of its series, sizes of 4 to 8, bounds of the rest and its bend.

    It is the force of the interface: that of its spring, or the net force of springs and dashpots.
    """
    rate, weight = motion.rate, motion.weight
    near, far = i - ONE, i + ONE
    if additions.anchor[i] > 0.0:
        b = additions.anchor[i]
        g1, g2, g3 = b * rate[ZERO, i] * weight[1], b * rate[ONE, i] * weight[2], b * rate[TWO, i] * weight[3]
        r4, r5 = b * abs(rate[THREE, i]) * weight[4], b * abs(rate[FOUR, i]) * weight[5]
        r6, r7 = b * abs(rate[FIVE, i]) * weight[6], b * abs(rate[SIX, i]) * weight[7]
        r8 = b * abs(rate[SEVEN, i]) * weight[8]
        rest = (r4 + r5) + (r6 + r7) + (r8 + b * tail * span / 9.0)
        return additions.grip[i], g1, g2, g3, r4, r5, r6, r7, r8, rest, b * tail_bend * span / 7.0
    b, a = coupling[i], coupling[far]
    d, c = additions.dashpot[i], additions.dashpot[far]
    net = tension[i] - tension[far] + d * rate[ZERO, near] + c * rate[ZERO, far]
    g1 = (b * rate[ZERO, near] + a * rate[ZERO, far] + d * rate[ONE, near] + c * rate[ONE, far]) * weight[1]
    g2 = (b * rate[ONE, near] + a * rate[ONE, far] + d * rate[TWO, near] + c * rate[TWO, far]) * weight[2]
    g3 = (b * rate[TWO, near] + a * rate[TWO, far] + d * rate[THREE, near] + c * rate[THREE, far]) * weight[3]
    r4 = abs(b * rate[THREE, near] + a * rate[THREE, far] + d * rate[FOUR, near] + c * rate[FOUR, far])
    r5 = abs(b * rate[FOUR, near] + a * rate[FOUR, far] + d * rate[FIVE, near] + c * rate[FIVE, far])
    r6 = abs(b * rate[FIVE, near] + a * rate[FIVE, far] + d * rate[SIX, near] + c * rate[SIX, far])
    r7 = abs(b * rate[SIX, near] + a * rate[SIX, far] + d * rate[SEVEN, near] + c * rate[SEVEN, far])
    r8 = abs(b * rate[SEVEN, near] + a * rate[SEVEN, far]) * weight[8]
    r4, r5, r6, r7 = r4 * weight[4], r5 * weight[5], r6 * weight[6], r7 * weight[7]
    beyond = (a + b) * span / 9.0 + c + d
    rest = (r4 + r5) + (r6 + r7) + (r8 + beyond * tail)
    return net, g1, g2, g3, r4, r5, r6, r7, r8, rest, ((a + b) * span / 7.0 + c + d) * tail_bend
