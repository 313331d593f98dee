"""Prove that no transition comes before the guessed one; search if the proof fails.

The proof shows that an event function g has no root before the time reached. Let u be
the share of this time. On [0, 1], g is a power series in u with the terms a_n:

    g(u) = a_0 + a_1 u + ... + a_5 u^5 + u^6 r(u),    r(u) = a_6 + a_7 u + a_8 u^2 + ...

Let R = |a_7| + 2 |a_8| + 3 |a_9| + ... >= |r'|, so that r(u) differs from r(1) by at
most (1 - u) R. The value g(1), which is known to rounding, then replaces all terms from
the sixth on:

    Q(u) - u^6 (1 - u) R <= g(u) <= Q(u) + u^6 (1 - u) R,
    Q(u) = a_0 + ... + a_5 u^5 + r(1) u^6,    Q(1) = g(1).

The Bernstein coefficients of Q of degree 6 are b_k = sum_j C(k, j) a_j / C(6, j) for k
< 6, and b_6 = g(1). In degree 7 they are means of neighbours, (k b_{k-1} + (7 - k) b_k)
/ 7, and u^6 (1 - u) has one coefficient, 1/7 at k = 6. On [0, 1] a polynomial lies
between its smallest and largest coefficients, so g lies between

    min(b_0, ..., b_5, g(1), (6 b_5 + g(1) - R) / 7)  and
    max(b_0, ..., b_5, g(1), (6 b_5 + g(1) + R) / 7).

If the lower bound is not negative, then g > 0 on (0, 1) unless all coefficients are
zero, because each Bernstein polynomial is positive there.
"""

import math

import numpy as np

from precursors.solver.kernel import lanes
from precursors.solver.kernel.arrays import (
    FELT,
    HOLD,
    MODE,
    NET_FORCE,
    RATE,
    SERIES,
    SIGN,
    SLIDES,
    UNDECIDED,
    VELOCITY,
    WEIGHT,
)
from precursors.solver.kernel.decorators import inner, seldom
from precursors.solver.kernel.guess import watched
from precursors.solver.kernel.layout import WIDTH, WINDOW
from precursors.solver.kernel.roots import first_root, zero_below

# For n >= 9, sum_n (n - 6) s^n/n! is at most TAIL s^9/9! if s is at most the longest
# window.
TAIL = sum(
    (n - 6) * WINDOW ** (n - 9) * math.factorial(9) / math.factorial(n)
    for n in range(9, 40)
)


@inner
def enclose(a0, a1, a2, a3, a4, a5, at_end, rest):
    """Return bounds of g on [0, 1] in each lane: (lower, upper).

    a0..a5 are a_j / C(6, j), `at_end` is g(1), and `rest` is R. The lower bound omits
    g(1) itself, because the function whose root ends the window is zero there to
    rounding.
    """
    # Pascal's triangle: each sum adds two neighbours above it. For example, b_2 is a012
    # = a0 + 2 a1 + a2.
    a01 = a0 + a1
    a12 = a1 + a2
    a23 = a2 + a3
    a34 = a3 + a4
    a45 = a4 + a5
    a012 = a01 + a12
    a123 = a12 + a23
    a234 = a23 + a34
    a345 = a34 + a45
    a0123 = a012 + a123
    a1234 = a123 + a234
    a2345 = a234 + a345
    a01234 = a0123 + a1234
    b5 = a01234 + (a1234 + a2345)
    low = lanes.smaller(lanes.smaller(a0, a01), lanes.smaller(a012, a0123))
    low = lanes.smaller(low, lanes.smaller(a01234, b5))
    high = lanes.larger(lanes.larger(a0, a01), lanes.larger(a012, a0123))
    high = lanes.larger(high, lanes.larger(a01234, b5))
    last = 6.0 * b5 + at_end
    high = lanes.larger(lanes.larger(high, at_end), (last + rest) * (1.0 / 7.0))
    return lanes.smaller(low, (last - rest) * (1.0 / 7.0)), high


@inner
def prove(end, candidate, motion):
    """Mark in UNDECIDED the blocks that may change their mode before the time reached;
    return zero if there are none.

    `move` has brought the state to that time, at which the function of block
    `candidate` vanishes. A sticking block must not reach its other limit either, where
    g = 2 mu_s w.
    """
    weight = motion[WEIGHT]
    open_blocks = 0
    # No later row of a velocity is larger than rows 7 and 8; the same holds for row 10
    # of a net force.
    largest = lanes.spread(0.0)
    for i in range(1, end + 1, WIDTH):
        for n in (7, 8):
            rows = lanes.magnitude(lanes.load(motion, RATE + n, i))
            largest = lanes.larger(largest, rows)
    tail = TAIL * weight[9] * lanes.largest(largest)
    for i in range(1, end + 1, WIDTH):
        slides = lanes.load(motion, SLIDES, i)
        sign = lanes.load(motion, SIGN, i)
        hold = lanes.load(motion, HOLD, i)
        felt = lanes.load(motion, FELT, i)
        now = lanes.choose(
            slides, lanes.load(motion, VELOCITY, i), lanes.load(motion, NET_FORCE, i)
        )
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
        undecided = lanes.where_negative(at_end * felt)
        if i <= candidate < i + WIDTH:
            undecided &= ~(1 << (candidate - i))
        undecided |= lanes.where_negative(low * felt)
        motion[UNDECIDED, i] = undecided
        open_blocks |= undecided
    return open_blocks


@seldom
def search(order, end, roundings, motion, progress):
    """Return the first root of the blocks in UNDECIDED: (share of the time reached,
    block, side)."""
    share = np.inf
    block = 0
    side = 1
    for group in range(1, end + 1, WIDTH):
        undecided = int(motion[UNDECIDED, group])
        for i in range(group, group + WIDTH):
            if (undecided >> (i - group)) & 1:
                zero = zero_below(i, roundings, motion)
                slides = motion[MODE, i] != 0
                for way in range(1, 0 if slides else -2, -2):
                    fill_series(i, motion[SIGN, i] if slides else -way, order, motion)
                    s = first_root(order + 1, zero, motion[SERIES], progress)
                    progress.searches += 1
                    if s < share:
                        share = s
                        block = i
                        side = way
    return share, block, side


@inner
def fill_series(i, sign, order, motion):
    """Fill SERIES with the event function of block i, in units of the time reached."""
    lowest = 0 if motion[SLIDES, i] > 0.0 else 1
    motion[SERIES, 0] = motion[HOLD, i] + sign * motion[RATE + lowest, i]
    for n in range(1, order + 1):
        motion[SERIES, n] = sign * motion[RATE + lowest + n, i] * motion[WEIGHT, n]
