"""Guess the block and the time of the next transition."""

import numpy as np

from precursors.solver.kernel import lanes
from precursors.solver.kernel.arrays import (
    FELT,
    HOLD,
    RATE,
    SIGN,
    SLIDES,
    WEIGHT,
    WHOLE,
)
from precursors.solver.kernel.decorators import inner
from precursors.solver.kernel.layout import PROOF_ORDER, WIDTH
from precursors.solver.kernel.series import powers

# A root this near to the start is left to the search, because a block that has just
# begun to move has its last transition there.
NEAR = 1e-6
# The window is shortened to MARGIN times the guess, so that it needs fewer rows, but
# not below the share LEAST.
MARGIN = 1.2
LEAST = 0.125
# Steps to the root: the first use the terms of the guess, the others use all terms.
EARLY_STEPS = 2
STEPS = 6
# After a step this short, relative to the time, the error is negligible: in Halley's
# method it is of the order of the cube of the step.
LAST_STEP = 2e-6


@inner
def watched(n, i, slides, motion):
    """Return the n-th derivative of the event functions g of a group, apart from sign
    and constant.

    A root of g is a transition. If a block slides, g is its velocity in the direction
    in which it slides, and a root is a stop. If it sticks, g is the margin mu_s w -
    side F on the side that is nearer at the start (Eq. 5), and a root is a release.
    SIGN is the direction of sliding, or -side; HOLD is mu_s w.
    """
    return lanes.choose(
        slides, lanes.load(motion, RATE + n, i), lanes.load(motion, RATE + n + 1, i)
    )


@inner
def two_terms(n, i, slides, motion):
    """Return the sum of terms n and n + 1 of the event functions at the end of the
    window."""
    first = motion[WHOLE, n] * watched(n, i, slides, motion)
    return first + motion[WHOLE, n + 1] * watched(n + 1, i, slides, motion)


@inner
def guess(end, motion):
    """Guess whose event function vanishes first; return (share of the window, block).

    Without a root these are (infinity, 0). The root of a function that is negative at
    the end of the window is guessed from a parabola with the same value and slope at
    the start, and the same value at the end.
    """
    zero = lanes.spread(0.0)
    share = np.inf
    block = 0
    for i in range(1, end + 1, WIDTH):
        slides = lanes.load(motion, SLIDES, i)
        nearer = lanes.choose(
            lanes.load(motion, RATE + 1, i), lanes.spread(-1.0), lanes.spread(1.0)
        )
        sign = lanes.choose(slides, lanes.load(motion, SIGN, i), nearer)
        g = sign * watched(0, i, slides, motion) + lanes.load(motion, HOLD, i)
        slope = sign * watched(1, i, slides, motion) * motion[WHOLE, 1]
        bend = two_terms(2, i, slides, motion) + two_terms(4, i, slides, motion)
        bend = sign * (bend + two_terms(6, i, slides, motion))
        lanes.store(motion, SIGN, i, sign)
        below = lanes.only(lanes.load(motion, FELT, i), zero - (g + (slope + bend)))
        if lanes.where_negative(zero - below) == 0:
            continue
        root = lanes.square_root(lanes.larger(slope * slope - 4.0 * (g * bend), zero))
        # The root of g + slope u + bend u^2 in [0, 1], in the form without
        # cancellation.
        u = lanes.choose(slope, slope + root, 2.0 * g) / lanes.choose(
            slope, -2.0 * bend, root - slope
        )
        u = lanes.choose(below, u, lanes.spread(np.inf))
        smallest = lanes.smallest(u)
        if smallest < share:
            share = smallest
            block = i
            bits = ~lanes.where_negative(smallest - u)
            while bits & 1 == 0:
                bits >>= 1
                block += 1
    return (share, block) if share > NEAR else (np.inf, 0)


@inner
def find_root(s, i, order, motion, progress):
    """Return the root near s of the event function of block i, or infinity.

    Row WEIGHT is overwritten.
    """
    for k in range(STEPS):
        terms = PROOF_ORDER if k < EARLY_STEPS else order
        powers(s, terms, WEIGHT, motion)
        g, slope, bend = function_at(i, terms, motion)
        step = 2.0 * g * slope / (2.0 * slope * slope - g * bend)
        s -= step
        progress.root_steps += 1
        if k >= EARLY_STEPS and abs(step) <= LAST_STEP * s:
            return s
    return np.inf


@inner
def function_at(i, order, motion):
    """Return the event function of block i and two derivatives at the time of WEIGHT.

    The series is cut after `order`, which is even.
    """
    sign = motion[SIGN, i]
    lowest = 0 if motion[SLIDES, i] > 0.0 else 1
    terms = motion[RATE + lowest :, i]
    weights = motion[WEIGHT]
    start = terms[0]
    c1 = terms[1]
    c2 = terms[2]
    g = g_odd = slope = slope_odd = bend = bend_odd = 0.0
    # Even and odd terms are summed apart: two short chains of sums run in parallel.
    for n in range(order, 2, -2):
        even = terms[n]
        odd = terms[n - 1]
        w = weights[n]
        w1 = weights[n - 1]
        w2 = weights[n - 2]
        g += w * even
        g_odd += w1 * odd
        slope += w1 * even
        slope_odd += w2 * odd
        bend += w2 * even
        bend_odd += weights[n - 3] * odd
    g += g_odd + weights[2] * c2 + weights[1] * c1
    slope += slope_odd + weights[1] * c2
    return (
        (motion[HOLD, i] + sign * start) + sign * g,
        sign * (c1 + slope),
        sign * (c2 + (bend + bend_odd)),
    )
