"""Prove that no transition comes before the one that was guessed; search where the proof fails."""

from __future__ import annotations

import numpy as np

from precursors.solver.kernel import lanes
from precursors.solver.kernel.arrays import row
from precursors.solver.kernel.bounds import TAIL, enclose
from precursors.solver.kernel.compiled import inner, seldom
from precursors.solver.kernel.guess import watched
from precursors.solver.kernel.layout import WIDTH
from precursors.solver.kernel.roots import first_root, zero_below


@inner
def prove(end, candidate, motion):
    """Mark the blocks in `open` that may change their mode before the time reached; zero if there are none.

    The state has been brought there by `move`. Of block `candidate` it is known that its function
    vanishes there. A block that sticks must not reach its other limit either, where g = 2 mu_s w.
    """
    weight, found = motion.weight, 0
    # No later row of a velocity is larger than rows 7 and 8, nor the tenth of a net force.
    largest = lanes.spread(0.0)
    for i in range(1, end + 1, WIDTH):
        largest = lanes.larger(largest, lanes.magnitude(lanes.load(row(7, motion), i)))
        largest = lanes.larger(largest, lanes.magnitude(lanes.load(row(8, motion), i)))
    tail = TAIL * weight[9] * lanes.largest(largest)
    for i in range(1, end + 1, WIDTH):
        slides, sign = lanes.load(motion.slides, i), lanes.load(motion.sign, i)
        hold, felt = lanes.load(motion.hold, i), lanes.load(motion.felt, i)
        now = lanes.choose(slides, lanes.load(motion.velocity, i), lanes.load(motion.net_force, i))
        at_end = sign * now + hold
        rest = lanes.magnitude(watched(7, i, slides, motion)) * weight[7]
        rest = rest + lanes.magnitude(watched(8, i, slides, motion)) * (2.0 * weight[8])
        low, high = enclose(
            sign * watched(0, i, slides, motion) + hold,
            sign * watched(1, i, slides, motion) * (weight[1] * (1.0 / 6.0)),
            sign * watched(2, i, slides, motion) * (weight[2] * (1.0 / 15.0)),
            sign * watched(3, i, slides, motion) * (weight[3] * (1.0 / 20.0)),
            sign * watched(4, i, slides, motion) * (weight[4] * (1.0 / 15.0)),
            sign * watched(5, i, slides, motion) * (weight[5] * (1.0 / 6.0)),
            at_end,
            rest + felt * tail,
        )
        low = lanes.choose(slides, low, lanes.smaller(low, 2.0 * hold - high))
        open = lanes.where_negative(at_end * felt)
        if i <= candidate < i + WIDTH:
            open &= ~(1 << (candidate - i))
        open |= lanes.where_negative(low * felt)
        motion.open[i] = open
        found |= open
    return found


@seldom
def search(order, end, roundings, chain, motion, progress):
    """First root of the functions of the blocks in `open`: (share of the time reached, block, side)."""
    share, block, side = np.inf, 0, 1
    for group in range(1, end + 1, WIDTH):
        open = motion.open[group]
        for i in range(group, group + WIDTH):
            if (open >> (i - group)) & 1:
                zero = zero_below(i, roundings, chain, motion)
                slides = motion.mode[i] != 0
                for way in range(1, 0 if slides else -2, -2):
                    fill_series(i, motion.sign[i] if slides else -way, order, motion)
                    s = first_root(order + 1, zero, motion.series, progress)
                    progress.searches += 1
                    if s < share:
                        share, block, side = s, i, way
    return share, block, side


@inner
def fill_series(i, sign, order, motion):
    """Series of the function watched of block i, with the time reached as unit."""
    weight, series = motion.weight, motion.series
    lowest = 0 if motion.slides[i] > 0.0 else 1
    series[0] = motion.hold[i] + sign * row(lowest, motion)[i]
    for n in range(1, order + 1):
        series[n] = sign * row(lowest + n, motion)[i] * weight[n]
