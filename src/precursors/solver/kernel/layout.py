"""What all parts of the kernel agree on: sizes, orders, and the places of numbers in its arrays."""

from __future__ import annotations

import math

import numpy as np

REACH = 2.0
# Blocks are worked on four at a time.
WIDTH = 4
# Columns beyond block N: the free end, and room for up to three blocks that are not there.
BEYOND = WIDTH
# The series of a window of length r is cut before (REACH r)^n / n! < NEGLIGIBLE.
NEGLIGIBLE = 2e-17
# Where more than LONG blocks move, a transition renews its neighbourhood only.
LONG = 24
# Longest window [tau].
WINDOW = 0.6


def order_for(length: float) -> int:
    """Order at which the series of a window of a length [tau] may be cut."""
    n, beyond = 0, REACH * length
    while n < 8 or beyond > NEGLIGIBLE:
        n += 1
        beyond *= REACH * length / (n + 1)
    return n


ORDER = order_for(WINDOW)
# Last row of the Taylor arrays.
ROWS = ORDER + 1
# A value below so many roundings of the forces it was computed from counts as zero. Where transitions follow
# one another without time going on, rounding decides in a circle: the limit is doubled until it does not.
ROUNDINGS = 8 * float(np.finfo(float).eps)
# A root is found where what is left of the function is so small a share of that.
AT_ROOT = 2.0**-12

# A run reached its duration; it ended before, at rest or in a long slip; or it can go on.
FINISHED, STOPPED, PAUSED = 0, 1, 2

# `clock`: time of the event's onset and its rounding error [s], time since then [tau], time since the last
# transition [tau].
ONSET, ONSET_ERROR, ELAPSED, SINCE = range(4)
# `counts`: transitions, sliding blocks, whether all slid at once, stored states, windows, derivatives of
# single blocks that were computed, steps of the root search, how the run ended, the farthest block that may
# slide, transitions on end at one instant, and the column before one that is known not to move.
TRANSITIONS, SLIDING, GLOBAL, STORED, WINDOWS, DERIVATIVES, ROOT_STEPS, STATUS, FARTHEST, AT_ONCE, EDGE = (
    range(11)
)
CLOCK_SIZE, COUNT_SIZE = 4, 11

# What a bound comes from: nothing yet, though the series is there; one step; the cubic; the whole series; or
# it is the root itself.
BUILT, ROUGH, CUBIC, WHOLE, FINAL = range(5)
# Columns of `level`.
ORIGIN, SPAN, ZERO_BELOW, BEND, TURN, POWER, C0, C1, C2, C3, REST, STEPS = range(12)
LEVELS = 12
CUBIC_STEPS = 4
# A search that takes so many steps starts anew from where it is: near a flat start its steps are tiny.
RESTART = 12

REACH_SQUARED = REACH * REACH
# Sum of the geometric bound of the tail of a series relative to its first term, for spans up to 1.
TAIL = 1.1
INVERSE_FACTORIAL = np.array([1.0 / math.factorial(n) for n in range(ROWS + WIDTH)])
SECOND_DERIVATIVE = np.array([n * (n - 1.0) for n in range(ROWS + 1)])
REACH_POWER = REACH ** np.arange(ROWS + 1.0)
