"""Forces of the springs (Eqs. 2 and 3) after the slips of a window."""

from __future__ import annotations

from precursors.solver.kernel import lanes
from precursors.solver.kernel.compiled import inner, seldom
from precursors.solver.kernel.layout import ORDER
from precursors.solver.kernel.series import powers


@inner
def begin(end, motion):
    """Begin a window: no slips yet, and the spring forces of blocks 1..end + 1 as they are."""
    slip, origins, nothing = motion.slip, motion.origins, lanes.spread(0.0)
    slip[end + 1] = 0.0
    for i in range(1, end + 1, 4):
        lanes.store(slip, i, nothing)
        lanes.store(origins, i, nothing)
        lanes.store(motion.force_before, i, lanes.load(motion.spring_force, i))
        lanes.store(motion.rest_before, i, lanes.load(motion.force_rest, i))
    motion.force_before[end + 1] = motion.spring_force[end + 1]
    motion.rest_before[end + 1] = motion.force_rest[end + 1]


@inner
def stretch(first, final, chain, motion):
    """Forces of the springs from behind block first to ahead of `final`, after the slips in the window.

    They are carried in two doubles: the rounding of one, window after window, is the largest error of a run.
    """
    coupling, slip, before, rest_before = chain.coupling, motion.slip, motion.force_before, motion.rest_before
    left = lanes.spread(slip[first - 1])
    for i in range(first, final + 1, 4):
        here = lanes.load(slip, i)
        longer = lanes.behind(left, here) - here
        left = here
        change = lanes.load(coupling, i) * longer + lanes.load(rest_before, i)
        force, rest = two_sum(lanes.load(before, i), change)
        lanes.store(motion.spring_force, i, force)
        lanes.store(motion.force_rest, i, rest)
    i = final + 1
    change = coupling[i] * (slip[i - 1] - slip[i]) + rest_before[i]
    motion.spring_force[i], motion.force_rest[i] = two_sum(before[i], change)


@inner
def two_sum(a, b):
    """a + b rounded, and what the rounding took from it."""
    total = a + b
    back = total - a
    return total, (a - (total - back)) + (b - back)


@inner
def net_force(i, motion):
    """Force of the springs on block i."""
    force, rest = motion.spring_force, motion.force_rest
    return (force[i] - force[i + 1]) + (rest[i] - rest[i + 1])


@seldom
def load_at(t, chain, motion):
    """Tangential load at time t of the window, block 1 keeping its series and origin."""
    rate, weight, slip = motion.rate, motion.spare, motion.slip
    powers(t - motion.origins[1], weight)
    way = slip[1]
    for n in range(ORDER, -1, -1):
        way += weight[n + 1] * rate[n, 1]
    return motion.force_before[1] + chain.coupling[1] * (slip[0] - way)
