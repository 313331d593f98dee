"""Constants of all parts of the kernel: lanes, windows, orders, roundings, and how a
run can end."""

import math
from itertools import count

import numpy as np

# Blocks are worked on four at a time; there are as many columns beyond block N: the
# free end, and room.
WIDTH = 4
# Longest window, times the bound of the chain's largest frequency.
WINDOW = 1.5
# The series of a window of length r is cut before r^n / n! < NEGLIGIBLE.
NEGLIGIBLE = 2e-17
# The proof has the terms up to this order one by one, and a bound of the rest.
PROOF_ORDER = 8


def order_for(length: float) -> int:
    """Even order at which the series of a window of a length may be cut."""
    enough = (
        n
        for n in count(PROOF_ORDER, 2)
        if length ** (n + 1) / math.factorial(n + 1) <= NEGLIGIBLE
    )
    return next(enough)


ORDER = order_for(WINDOW)
# The same for times of a window that is cut into parts: ORDERS[int(PARTS * s)].
PARTS = 64 / WINDOW
ORDERS = np.array([order_for(min((k + 1) / PARTS, WINDOW)) for k in range(65)])
# Rows of the Taylor arrays: that of a net force begins a row later.
ROWS = ORDER + 2
# Room for the terms of a series, in whole groups.
TERMS = ROWS + 2 * WIDTH
INVERSE_FACTORIAL = np.array([[1.0 / math.factorial(n) for n in range(TERMS)]])
# A value below so many roundings of the forces it was computed from counts as zero.
# Transitions may follow one another for ever while time stands still, as roundings
# decide: the limit is doubled until they do not.
ROUNDINGS = 8 * float(np.finfo(float).eps)

# A run reached its duration; it ended before, at rest; or it can go on.
FINISHED = 0
STOPPED = 1
PAUSED = 2
