"""Bounds from below of the first root of a function known by its first terms and a bound of the rest."""

from __future__ import annotations

import math

import numpy as np

from precursors.solver.kernel.compiled import inner
from precursors.solver.kernel.layout import CUBIC_STEPS


@inner
def safe_step(g, slope, curvature):
    """Positive root of g + slope s - curvature s^2/2 for g >= 0: no root of g lies before it."""
    root = math.sqrt(slope * slope + 2.0 * curvature * g)
    if slope < 0.0:
        return 2.0 * g / (root - slope)
    return (slope + root) / curvature if curvature > 0.0 else np.inf


@inner
def cubic_bound(c0, c1, c2, c3, rest):
    """Bound the first root of c0 + c1 s + c2 s^2 + c3 s^3 + e, |e| <= rest s^4, from below; inf beyond 1."""
    curvature = downward(c2, c3) + 12.0 * rest
    s = safe_step(c0, c1, curvature)
    for _ in range(CUBIC_STEPS):
        if s >= 1.0:
            return np.inf
        ss = s * s
        g = c0 + s * (c1 + s * (c2 + s * c3)) - rest * ss * ss
        if g <= 0.01 * c0:
            return s
        s += safe_step(g, c1 + s * (2.0 * c2 + s * 3.0 * c3) - 4.0 * rest * ss * s, curvature)
    return s


@inner
def downward(c2, c3):
    """Bound of -g'' of a cubic on [0, 1]."""
    return 2.0 * max(-c2, 0.0) + 6.0 * max(-c3, 0.0)


@inner
def turning(c2, c3):
    """Bound of |g''| of a cubic on [0, 1]."""
    return 2.0 * abs(c2) + 6.0 * abs(c3)


@inner
def surely_positive(c0, c1, c2, c3, rest):
    """Whether c0 + c1 s + c2 s^2 + c3 s^3 + e, |e| <= rest, has no root in [0, 1]."""
    return c0 + min(c1, 0.0) + min(c2, 0.0) + min(c3, 0.0) > rest


@inner
def zero_below(i, roundings, chain, motion):
    """Size below which a force on block i, or what it does to its velocity in the window, counts as zero.

    It follows from the forces, and from what the motion of the neighbours adds to them within the window.
    """
    coupling, force, fastest = chain.coupling, motion.spring_force, motion.fastest
    still = abs(force[i]) + abs(force[i + 1]) + chain.strength[i]
    moving = coupling[i] * fastest[i - 1] + fastest[i] + coupling[i + 1] * fastest[i + 1]
    return roundings * (2.0 * still + moving)
