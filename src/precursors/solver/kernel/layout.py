"""What all parts of the kernel agree on: sizes, orders, and the places of numbers in its arrays."""

from __future__ import annotations

import math

import numpy as np

REACH = 2.0
# Rows of the Taylor arrays; the series of a window of length r is cut where (REACH r)^n / n! < NEGLIGIBLE.
ROWS = 30
# Blocks are worked on four at a time, so that loops are short and foreseeable.
WIDTH = 4
# Columns beyond block N: the free end, and room for up to three blocks that are not there.
BEYOND = WIDTH
NEGLIGIBLE = 1e-19
# Chains whose moving part is longer than LONG blocks renew neighbourhoods only, in windows of LONG_WINDOW.
LONG = 24
SHORT_WINDOW, LONG_WINDOW = 0.6875, 0.5
# On interface springs there is no rest: a state is stored after so many windows for each one of the stride.
WINDOWS_PER_STATE = 512
# While all blocks stick there, 2^k windows are gone through at once, k = LEAST_LEAP..LEAPS, where it is sure
# that none lets go; a state that allows none is looked at again after so many windows.
LEAST_LEAP, LEAPS, BETWEEN_LOOKS = 3, 9, 12
# The energy that bounds the ringing is known to better than this.
SAFETY = 1.0 + 1e-9
# A value below so many roundings of the forces it was computed from counts as zero. Where transitions follow
# one another without time going on, rounding decides in a circle: the doubt grows until it does not.
ROUNDINGS = 8 * float(np.finfo(float).eps)

FINISHED, GLOBAL_SLIP, PAUSED = 0, 1, 2

# `clock`: time of the event's onset and its rounding error [s], time since then [tau], time since the last
# transition [tau]. `count`: transitions, sliding blocks, whether all slid at once, stored states, windows,
# derivatives of single blocks that were computed, steps of the root search, and how the run ended.
ONSET, ONSET_ERROR, ELAPSED, SINCE = range(4)
TRANSITIONS, SLIDING, GLOBAL, STORED, WINDOWS, DERIVATIVES, ROOT_STEPS, STATUS = range(8)
CLOCK_SIZE, COUNT_SIZE = 4, 8

# What a bound is from: nothing yet, though the series is there; one step; the cubic; the whole series; or it
# is the root itself. Columns of `level`.
BUILT, ROUGH, CUBIC, WHOLE, FINAL = range(5)
ORIGIN, SPAN, DOUBT, BEND, TURN, POWER, C0, C1, C2, C3, REST, STEPS = range(12)
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
