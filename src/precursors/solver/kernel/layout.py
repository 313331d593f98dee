"""Constants of the kernel: lanes, windows, orders, roundings, and results of a run."""

import math
from itertools import count

import numpy as np

# Blocks are processed in groups of four. Four columns follow block N: the free end, and
# padding.
WIDTH = 4
# Longest window, times the bound of the chain's largest frequency.
WINDOW = 1.5
# The series of a window of length r is cut before r^n / n! < NEGLIGIBLE.
NEGLIGIBLE = 2e-17
# The proof uses the terms up to this order, and a bound of the remainder.
PROOF_ORDER = 8


def order_for(length: float) -> int:
    """Return the even order at which the series of a window may be cut."""
    enough = (
        n
        for n in count(PROOF_ORDER, 2)
        if length ** (n + 1) / math.factorial(n + 1) <= NEGLIGIBLE
    )
    return next(enough)


ORDER = order_for(WINDOW)
# Order for a time s within a window: ORDERS[int(PARTS * s)].
PARTS = 64 / WINDOW
ORDERS = np.array([order_for(min((k + 1) / PARTS, WINDOW)) for k in range(65)])
# Rows of the Taylor arrays; the series of a net force begins one row later.
ROWS = ORDER + 2
# Columns for the terms of a series, in complete groups.
TERMS = ROWS + 2 * WIDTH
INVERSE_FACTORIAL = np.array([[1.0 / math.factorial(n) for n in range(TERMS)]])
# A value below this share of the forces from which it was computed counts as zero.
# Rounding errors may cause transitions that repeat without time advancing; the share is
# then doubled until they end.
ROUNDINGS = 8 * float(np.finfo(float).eps)

# A run reached its duration, stopped at rest before, or can continue.
FINISHED = 0
STOPPED = 1
PAUSED = 2
