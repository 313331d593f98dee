"""Prove the conditions inside an interval between two transitions."""

import math
from typing import NamedTuple

import numpy as np

from precursors.audit.carried import advance, motion_of
from precursors.audit.motion import (
    ModalMotion,
    at,
    inner,
    largest_acceleration,
    outer,
)
from precursors.model.chain import FloatArray
from precursors.solver.record import IntArray

_FEWEST_CELLS = 2
_PARTS = 8  # of a cell that cannot be proved as a whole
_MOST_SHOWN = 200_000  # largest number of values of an interval with a problem


class Conditions(NamedTuple):
    """Functions that must not be negative in an interval.

    Each is base + rate s plus a sum over modes, where s is the time since the start of
    the interval. There is one for each sliding block: its velocity [m/s] in the
    direction of its mode. Two follow for each stuck block whose force can change: mu_s
    w - force and mu_s w + force [N]. The first `n_speeds` are sums of modal velocities,
    the others of displacements. `fourth` bounds the fourth derivative.
    """

    motion: ModalMotion
    n_speeds: int
    base: FloatArray
    rate: FloatArray
    share: FloatArray
    fourth: FloatArray


class Passed(NamedTuple):
    """Result for an interval.

    For each condition it has the lowest value, its time, and the size of one rounding.
    `sliding` and `stuck` are the blocks of the conditions, counted from 0. `computed`
    is the number of values computed.
    """

    lowest: FloatArray
    when: FloatArray
    rounding: FloatArray
    sliding: IntArray
    stuck: IntArray
    computed: int

    def describe(self, column: int, mode: IntArray) -> tuple[str, str]:
        """Return a sentence and a unit for a condition that is violated."""
        n = len(self.sliding)
        if column < n:
            i = self.sliding[column]
            return f"block {i + 1} slides against its mode {mode[i]:+d} at", "m/s"
        way, k = divmod(column - n, len(self.stuck))
        direction = "backward" if way else "forward"
        block = self.stuck[k] + 1
        return f"block {block} is stuck, pushed {direction} beyond mu_s w by", "N"


@outer
def pass_interval(state, rows, modes, duration, roundings, most):
    """Prove the conditions of an interval in which `rows` of blocks move, and advance
    the state to its end."""
    motion = motion_of(state, rows, modes)
    sliding, stuck = concerned(state, rows)
    conditions = conditions_of(motion, state, rows, modes, sliding, stuck)
    advance(state, rows, modes, motion, duration)
    of_force = state.per_force[stuck]
    of_speed = np.full(len(sliding), 1.0 / math.sqrt(state.mass))
    rounding = state.rounding[0] * np.concatenate((of_speed, of_force, of_force))
    lowest, when, computed = prove(conditions, duration, roundings * rounding, most)
    return Passed(lowest, when, rounding, sliding, stuck, computed)


@inner
def concerned(state, rows):
    """Return the blocks that slide, and the stuck blocks whose force can change: block
    1 and neighbours of moving blocks."""
    is_near = np.zeros(len(state.mode), np.bool_)
    is_near[0] = True
    for first, end in rows:
        is_near[max(first - 1, 0)] = True
        is_near[first:end] = False
        is_near[end : end + 1] = True
    return np.flatnonzero(np.abs(state.mode) == 1), np.flatnonzero(is_near)


@inner
def conditions_of(motion, state, rows, modes, sliding, stuck):
    """Return the conditions of an interval from the state at its start."""
    n = len(sliding)
    m = len(stuck)
    force = state.spring_force[stuck] - state.spring_force[stuck + 1]
    strength = state.strength[stuck]
    base = np.concatenate((np.zeros(n), strength - force, strength + force))
    rate = np.zeros(len(base))
    if m and stuck[0] == 0:
        rate[n] = -state.loading_rate
        rate[n + m] = state.loading_rate
    column = np.full(len(state.mode), -1)  # index of each block's condition
    column[sliding] = np.arange(n)
    column[stuck] = np.arange(n, n + m)
    bends = motion.omega**2
    share = np.zeros((len(base), len(bends)))
    j = 0
    k = 0
    for first, end in rows:
        for _ in range(first, end):
            bends[j] *= largest_acceleration(motion, j)
            # The springs at both ends of a row pull at stuck blocks.
            if first > 0:
                share[column[first - 1], j] = -modes.spring_shapes[k + j]
            for i in range(first, end):
                if abs(state.mode[i]) == 1:
                    share[column[i], j] = state.mode[i] * modes.shapes[k]
                k += 1
            if end < len(state.mode):
                share[column[end], j] = modes.spring_shapes[k + j]
            j += 1
    share[n + m :] = -share[n : n + m]
    fourth = np.dot(np.abs(share), bends)
    fourth[:n] = np.dot(np.abs(share[:n]), bends * motion.omega)
    return Conditions(motion, n, base, rate, share, fourth)


@inner
def take_modes(motion, s, modal):
    """Set the displacements, velocities and accelerations of all modes at time s."""
    for j in range(len(motion.omega)):
        modal[0, j], modal[1, j], modal[2, j] = at(motion, j, s)


@inner
def value_and_slope(conditions, column, s, modal):
    """Return value and slope of a condition at time s, from the modes at that time."""
    value = conditions.base[column] + conditions.rate[column] * s
    slope = conditions.rate[column]
    order = 1 if column < conditions.n_speeds else 0
    for j in range(len(conditions.motion.omega)):
        share = conditions.share[column, j]
        value += share * modal[order, j]
        slope += share * modal[order + 1, j]
    return value, slope


@inner
def prove(conditions, duration, tolerance, most):
    """Return the lowest values and their times, each of shape (number of conditions,),
    and the number of values computed.

    If no computed value is below -tolerance, then no value anywhere in the interval is
    below -2 tolerance. Proof: let M bound the fourth derivative of a function g. On a
    cell of width d, g then differs by at most M d^4/384 from the cubic with the same
    values and slopes at both ends, and a cubic is not below its least Bernstein
    coefficient. A cell for which this bound is not sufficient is cut, unless a value is
    below -tolerance. The search ends after more than `most` values.
    """
    columns = len(tolerance)
    n_modes = len(conditions.motion.omega)
    n_cells = 1
    if n_modes:
        # A cell of a radian of the fastest mode can usually be proved.
        fastest = conditions.motion.omega.max()
        n_cells = max(_FEWEST_CELLS, math.ceil(duration * fastest))
    modal = np.empty((3, n_modes))
    inside = np.empty((3, n_modes))
    lowest = np.empty(columns)
    slopes = np.empty(columns)
    when = np.zeros(columns)
    take_modes(conditions.motion, 0.0, modal)
    for c in range(columns):
        lowest[c], slopes[c] = value_and_slope(conditions, c, 0.0, modal)
    values = lowest.copy()
    computed = columns
    is_broken = False
    start = 0.0
    for k in range(n_cells):
        end = duration / n_cells * (k + 1)
        take_modes(conditions.motion, end, modal)
        for c in range(columns):
            value, slope = value_and_slope(conditions, c, end, modal)
            bound = lower_bound(
                end - start, values[c], value, slopes[c], slope, conditions.fourth[c]
            )
            if bound < -2 * tolerance[c] and not is_broken:
                computed += cut(
                    conditions,
                    c,
                    start,
                    end,
                    values[c],
                    slopes[c],
                    tolerance[c],
                    most - computed,
                    lowest,
                    when,
                    inside,
                )
            if value < lowest[c]:
                lowest[c] = value
                when[c] = end
            values[c] = value
            slopes[c] = slope
        computed += columns
        start = end
        is_broken |= bool(np.any(lowest < -tolerance))
        if computed > most or (is_broken and computed > _MOST_SHOWN):
            break
    return lowest, when, computed


@inner
def cut(
    conditions,
    column,
    start,
    stop,
    low,
    rise,
    tolerance,
    most,
    lowest,
    when,
    modal,
):
    """Prove a condition in a cell by smaller steps; return the number of values
    computed.

    `low` and `rise` are value and slope at the start of the cell.
    """
    width = (stop - start) / _PARTS
    computed = 0
    while start < stop and computed <= most:
        end = min(start + width, stop)
        take_modes(conditions.motion, end, modal)
        high, fall = value_and_slope(conditions, column, end, modal)
        computed += 1
        if high < lowest[column]:
            lowest[column] = high
            when[column] = end
        bound = lower_bound(
            end - start, low, high, rise, fall, conditions.fourth[column]
        )
        if bound < -2 * tolerance and not lowest[column] < -tolerance:
            width /= _PARTS
        else:
            start = end
            low = high
            rise = fall
            width *= 2
    return computed


@inner
def lower_bound(width, low, high, rise, fall, fourth):
    """Return a lower bound of a function in a cell.

    It follows from the values `low` and `high` and the slopes `rise` and `fall` at both
    ends, and from a bound of the fourth derivative.
    """
    inside = min(low + rise * (width / 3), high - fall * (width / 3))
    return min(low, high, inside) - fourth * (width**4 / 384)
