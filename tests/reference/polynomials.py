"""First zero of a polynomial on [0, 1] in fixed-point integers, isolated by Bernstein
coefficients.

A polynomial lies in the convex hull of its Bernstein coefficients: if all are positive
it has no zero, and if they decrease it is monotone. An interval for which neither holds
is halved, the left half first, so that no pair of zeros is stepped over (Lane and
Riesenfeld 1981, BIT 21, 112-117).

A number x is stored as the integer nearest to x 2^bits, a polynomial as its
coefficients, lowest first.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import accumulate, pairwise
from math import comb

# What is smaller than 2^GUARD_BITS units of the last place counts as zero.
GUARD_BITS = 48
# The coefficients fall like 2^n/n!, so the rest after degree 20 is below 1e-12.
COARSE_DEGREE = 20


def first_zero(p: Sequence[int], bits: int) -> int | None:
    """Return the first point of [0, 1] at which p is not positive (crosses or touches
    zero), or None."""
    if p[0] <= 0:
        return 0
    tolerance = 1 << GUARD_BITS
    if p[0] - sum(map(abs, p[1:])) > tolerance:
        return None
    rest = sum(map(abs, p[COARSE_DEGREE + 1 :]))
    if min(bernstein(p[: COARSE_DEGREE + 1])) - rest > tolerance:
        return None
    pieces = [(0, 0, bernstein(p))]
    while pieces:
        left, depth, b = pieces.pop()
        if min(b) > tolerance:
            continue
        low, high = left << (bits - depth), (left + 1) << (bits - depth)
        if all(later < earlier for earlier, later in pairwise(b)):
            if b[-1] > 0:
                continue
            x = crossing(p, low, high, bits)
            # So small a slope means a minimum less than the tolerance below zero.
            touches = value(derivative(p), x, bits) > -(1 << (bits + GUARD_BITS) // 2)
            return touching(p, x, bits) if touches else x
        if b[0] <= tolerance or depth == bits // 2:
            return touching(p, low, bits)
        first, second = halves(b)
        pieces += [(2 * left + 1, depth + 1, second), (2 * left, depth + 1, first)]
    return None


def bernstein(p: Sequence[int]) -> list[int]:
    """Bernstein coefficients of p on [0, 1]: their k-th forward differences at 0 are
    p_k / C(n, k)."""
    n = len(p) - 1
    b: list[int] = []
    for k in range(n, -1, -1):
        b = list(accumulate([(p[k] << n) // comb(n, k), *b]))
    return [coefficient >> n for coefficient in b]


def halves(b: Sequence[int]) -> tuple[list[int], list[int]]:
    """Bernstein coefficients on the two halves of the interval (de Casteljau)."""
    row, first, second = list(b), [b[0]], [b[-1]]
    while len(row) > 1:
        row = [(left + right) >> 1 for left, right in pairwise(row)]
        first.append(row[0])
        second.append(row[-1])
    return first, second[::-1]


def value(p: Sequence[int], x: int, bits: int) -> int:
    """Value of p at x (Horner)."""
    result = 0
    for coefficient in reversed(p):
        result = (result * x >> bits) + coefficient
    return result


def derivative(p: Sequence[int]) -> list[int]:
    """Coefficients of p'."""
    return [k * coefficient for k, coefficient in enumerate(p)][1:]


def crossing(p: Sequence[int], low: int, high: int, bits: int) -> int:
    """Zero of a p that decreases on [low, high], by Newton's method, or halving where
    that is slow."""
    if value(p, low, bits) <= 0:
        return low
    slope = derivative(p)
    x = (low + high) >> 1
    while high - low > 1:
        at_x, slope_at_x = value(p, x, bits), value(slope, x, bits)
        low, high = (x, high) if at_x > 0 else (low, x)
        step = -(at_x << bits) // slope_at_x if slope_at_x < 0 else high - low
        if abs(step) <= 1:
            return x
        converges = 2 * abs(step) <= high - low and low < x + step < high
        x = x + step if converges else (low + high) >> 1
    return high


def touching(p: Sequence[int], x: int, bits: int) -> int:
    """Point next to x at which p, zero there to rounding, has its minimum."""
    reach = 1 << (bits + GUARD_BITS) // 2 + 8
    low, high = max(x - reach, 0), min(x + reach, 1 << bits)
    return crossing([-coefficient for coefficient in derivative(p)], low, high, bits)
