"""Proofs that a function has no root, and steps that pass none.

**No root before the end.** Let g be a power series in u on [0, 1] with the terms a_n:

    g(u) = a_0 + a_1 u + ... + a_5 u^5 + u^6 r(u),    r(u) = a_6 + a_7 u + a_8 u^2 + ...

Let R = |a_7| + 2 |a_8| + 3 |a_9| + ... >= |r'|, so that r(u) differs from r(1) by (1 - u) R at most. Then the
value g(1), which is known to rounding, replaces all terms from the sixth on:

    Q(u) - u^6 (1 - u) R <= g(u) <= Q(u) + u^6 (1 - u) R,
    Q(u) = a_0 + ... + a_5 u^5 + r(1) u^6,    Q(1) = g(1).

The Bernstein coefficients of Q of degree 6 are b_k = sum_j C(k, j) a_j / C(6, j) for k < 6, and b_6 = g(1).
In degree 7 they are means of neighbours, (k b_{k-1} + (7 - k) b_k) / 7, and u^6 (1 - u) has one coefficient,
1/7 at k = 6. On [0, 1] a polynomial lies between its smallest and largest coefficients, so g lies between

    min(b_0, ..., b_5, g(1), (6 b_5 + g(1) - R) / 7)  and  max(b_0, ..., b_5, g(1), (6 b_5 + g(1) + R) / 7).

If the lower one is not negative then g > 0 on (0, 1), or its lower bound is zero everywhere: each Bernstein
polynomial is positive there.
"""

from __future__ import annotations

import math

import numpy as np

from precursors.solver.kernel import lanes
from precursors.solver.kernel.compiled import inner
from precursors.solver.kernel.layout import WINDOW

# sum_n (n - 6) s^n/n! for n >= 9 is at most so many times s^9/9!, where s is at most the longest window.
TAIL = sum((n - 6) * WINDOW ** (n - 9) * math.factorial(9) / math.factorial(n) for n in range(9, 40))


@inner
def enclose(a0, a1, a2, a3, a4, a5, at_end, rest):
    """Bounds of g on [0, 1] in each lane: (lower, upper).

    a0..a5 are a_j / C(6, j), `at_end` is g(1), and `rest` is R. The lower bound leaves g(1) itself out: the
    function whose root ends the window is zero there, to rounding.
    """
    # Sums of neighbours, again and again, are the sums with binomial coefficients.
    c0, c1, c2, c3, c4 = a0 + a1, a1 + a2, a2 + a3, a3 + a4, a4 + a5
    d0, d1, d2, d3 = c0 + c1, c1 + c2, c2 + c3, c3 + c4
    e0, e1, e2 = d0 + d1, d1 + d2, d2 + d3
    f0, f1 = e0 + e1, e1 + e2
    b5 = f0 + f1
    low = lanes.smaller(lanes.smaller(a0, c0), lanes.smaller(d0, e0))
    low = lanes.smaller(low, lanes.smaller(f0, b5))
    high = lanes.larger(lanes.larger(a0, c0), lanes.larger(d0, e0))
    high = lanes.larger(high, lanes.larger(f0, b5))
    last = 6.0 * b5 + at_end
    high = lanes.larger(lanes.larger(high, at_end), (last + rest) * (1.0 / 7.0))
    return lanes.smaller(low, (last - rest) * (1.0 / 7.0)), high


@inner
def safe_step(g, slope, curvature):
    """Positive root of g + slope s - curvature s^2/2 (g >= 0): if -g'' <= curvature, no root is before."""
    root = math.sqrt(slope * slope + 2.0 * curvature * g)
    if slope < 0.0:
        return 2.0 * g / (root - slope)
    return (slope + root) / curvature if curvature > 0.0 else np.inf
