"""Margins mu_s w_i -+ F_i (Eq. 5) of blocks that stick: which may vanish in a window, and when."""

from __future__ import annotations

from precursors.solver.kernel import lanes
from precursors.solver.kernel.bounds import downward, safe_step, surely_positive, turning
from precursors.solver.kernel.compiled import inner
from precursors.solver.kernel.layout import (
    BEND,
    BUILT,
    C0,
    C1,
    C2,
    C3,
    ORDER,
    ORIGIN,
    POWER,
    REST,
    ROUGH,
    SPAN,
    TURN,
    ZERO_BELOW,
)
from precursors.solver.kernel.roots import keep
from precursors.solver.kernel.springs import net_force


@inner
def margin_series(slot, i, chain, motion, series):
    """Series of the margin of stuck block i against letting go forward (even slot) or backward (odd slot)."""
    rate, weight = motion.rate, motion.weight
    side = 1.0 - 2.0 * (slot % 2)
    b, a = chain.coupling[i], chain.coupling[i + 1]
    series[slot, 0] = chain.strength[i] - side * net_force(i, motion)
    for n in range(1, ORDER + 1):
        faster = b * rate[n - 1, i - 1] + a * rate[n - 1, i + 1]
        series[slot, n] = -side * faster * weight[n]


@inner
def may_let_go(i, span, chain, motion):
    """Bits of those of blocks i..i + 3 that stick and may let go in the window."""
    coupling, force, fastest = chain.coupling, motion.spring_force, motion.fastest
    slides = lanes.load(motion.sense, i) * lanes.load(motion.sense, i)
    still = 1.0 - slides
    net = lanes.magnitude(lanes.load(force, i) - lanes.load(force, i + 1))
    change = lanes.load(coupling, i) * lanes.load(fastest, i - 1)
    change = (change + lanes.load(coupling, i + 1) * lanes.load(fastest, i + 1)) * span
    return lanes.where_not_above(still * (lanes.load(chain.strength, i) - net), still * change - slides)


@inner
def watch_margins(i, window, zero, tails, chain, motion, search):
    """Bound the times at which stuck block i lets go forward or backward from below.

    `tails` bounds the rest of the neighbours' series, and its curvature.
    """
    rate, weight, fastest = motion.rate, motion.weight, motion.fastest
    level, stage, bound = search.level, search.stage, search.bound
    origin, span = window.origin, window.span
    tail, tail_bend = tails
    near, far = i - 1, i + 1
    b, a = chain.coupling[i], chain.coupling[far]
    if b * fastest[near] + a * fastest[far] == 0.0:
        return
    net = net_force(i, motion)
    # The net force grows with the velocities of the neighbours.
    g1 = (b * rate[0, near] + a * rate[0, far]) * weight[1]
    g2 = (b * rate[1, near] + a * rate[1, far]) * weight[2]
    g3 = (b * rate[2, near] + a * rate[2, far]) * weight[3]
    r4 = abs(b * rate[3, near] + a * rate[3, far]) * weight[4]
    r5 = abs(b * rate[4, near] + a * rate[4, far]) * weight[5]
    r6 = abs(b * rate[5, near] + a * rate[5, far]) * weight[6]
    r7 = abs(b * rate[6, near] + a * rate[6, far]) * weight[7]
    r8 = abs(b * rate[7, near] + a * rate[7, far]) * weight[8]
    rest = (r4 + r5) + (r6 + r7) + (r8 + (a + b) * tail * span / 9.0)
    for k in range(2):
        side = 1.0 - 2.0 * k
        c0, c1, c2, c3 = chain.strength[i] - side * net, -side * g1, -side * g2, -side * g3
        if surely_positive(c0, c1, c2, c3, rest):
            continue
        slot = 2 * i + k
        level[slot, ORIGIN], level[slot, SPAN], level[slot, ZERO_BELOW] = origin, span, zero
        if c0 > zero and not window.is_long:
            level[slot, POWER] = 0.0
            bend = 12.0 * r4 + 20.0 * r5 + 30.0 * r6 + 42.0 * r7 + 56.0 * r8
            bend += (a + b) * tail_bend * span / 7.0
            level[slot, BEND], level[slot, TURN] = downward(c2, c3) + bend, turning(c2, c3) + bend
            level[slot, C0], level[slot, C1], level[slot, C2], level[slot, C3] = c0, c1, c2, c3
            level[slot, REST] = rest
            stage[slot] = ROUGH
            bound[slot] = origin + safe_step(c0, c1, downward(c2, c3) + 12.0 * rest) * span
        else:
            # The series of the neighbours may get other origins before this one is looked at again.
            margin_series(slot, i, chain, motion, search.series)
            stage[slot], bound[slot] = BUILT, origin
        if bound[slot] < origin + span:
            keep(slot, search)
