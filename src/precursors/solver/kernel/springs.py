"""Forces of the springs (Eqs. 2 and 3) after the slips of a window."""

from __future__ import annotations

from precursors.solver.kernel import lanes
from precursors.solver.kernel.compiled import inner, seldom
from precursors.solver.kernel.series import powers


@inner
def stretch(first, final, chain, motion):
    """Forces of the springs from behind block first to ahead of `final`, after the slips in the window."""
    coupling, slip, before = chain.coupling, motion.slip, motion.force_before
    for i in range(first, final + 1, 4):
        longer = lanes.load(slip, i - 1) - lanes.load(slip, i)
        lanes.store(motion.spring_force, i, lanes.load(before, i) + lanes.load(coupling, i) * longer)
    i = final + 1
    motion.spring_force[i] = before[i] + coupling[i] * (slip[i - 1] - slip[i])


@seldom
def load_at(t, order, chain, motion):
    """Tangential load at time t of the window, block 1 keeping its series and origin."""
    rate, weight, slip = motion.rate, motion.weight, motion.slip
    powers(t - motion.origins[1], order, weight)
    way = slip[1]
    for n in range(order, -1, -1):
        way += weight[n + 1] * rate[n, 1]
    return motion.force_before[1] + chain.coupling[1] * (slip[0] - way)
