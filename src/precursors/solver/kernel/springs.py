"""Forces of springs (Eqs. 2 and 3) and dashpots, and what the slips of a window do to them."""

from __future__ import annotations

from precursors.solver.kernel import lanes
from precursors.solver.kernel.compiled import FOUR, ONE, index, inner, seldom
from precursors.solver.kernel.layout import BEYOND
from precursors.solver.kernel.series import powers


@inner
def stretch_springs(first, final, coupling, slip, tension_before, tension):
    """Forces of the springs from behind block first to ahead of `final`, after the slips in the window."""
    for i in range(index(first), index(final) + ONE, FOUR):
        longer = lanes.load(slip, i - ONE) - lanes.load(slip, i)
        lanes.store(tension, i, lanes.load(tension_before, i) + lanes.load(coupling, i) * longer)
    i = index(final) + ONE
    tension[i] = tension_before[i] + coupling[i] * (slip[i - ONE] - slip[i])


@inner
def stretch(first, final, chain, additions, ringing, state, motion):
    """Forces of the springs after the slips in a window; without drift on interface springs.

    What moves there goes through millions of windows.
    """
    coupling, slip = chain.coupling, motion.slip
    if additions is not None and on_springs(additions):
        for i in range(1, state.mode.shape[0] - BEYOND):
            add_to(state.tension, ringing.lost, i, coupling[i] * (slip[i - 1] - slip[i]))
        renew_grip(state.mode, chain.lightness, additions, motion, ringing.lost_grip)
    else:
        stretch_springs(first, final, coupling, slip, motion.tension_before, state.tension)


@seldom
def load_at(t, order, coupling, motion):
    """Tangential load at time t of the window, block 1 keeping its series and origin."""
    rate, weight, slip = motion.rate, motion.weight, motion.slip
    powers(t - motion.origins[1], order, weight)
    way = slip[1]
    for n in range(order, -1, -1):
        way += weight[n + 1] * rate[n, 1]
    return motion.tension_before[1] + coupling[1] * (slip[0] - way)


@inner
def net_force(i, tension, rate, additions):
    """Force of springs and dashpots on block i, G_i."""
    damped = additions.dashpot[i] * (rate[0, i - 1] - rate[0, i]) - additions.dashpot[i + 1] * (
        rate[0, i] - rate[0, i + 1]
    )
    return tension[i] - tension[i + 1] + damped


@inner
def on_springs(additions):
    """Whether blocks that stick hang on interface springs, and move."""
    return additions.anchor[ONE] > 0.0


@inner
def add_to(values, lost, i, change):
    """Add to values[i]; what rounding takes away is kept in lost[i] for the next time."""
    change += lost[i]
    total = values[i] + change
    lost[i] = change - (total - values[i])
    values[i] = total


@inner
def renew_grip(mode, lightness, additions, motion, lost):
    """Force of the interface springs after the slips in a window, and the push that follows from it."""
    n_blocks = mode.shape[0] - 1 - BEYOND
    slip, push = motion.slip, motion.push
    for i in range(1, n_blocks + 1):
        if mode[i] == 0:
            add_to(additions.grip, lost, i, additions.anchor[i] * slip[i])
            push[i] = lightness[i] * additions.grip[i]
