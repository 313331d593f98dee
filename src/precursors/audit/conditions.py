"""Conditions inside an interval between two transitions, and a proof of them."""

import math

import numpy as np

from precursors.audit.carried import CarriedState
from precursors.audit.motion import ModalMotion
from precursors.model.chain import FloatArray

_FEWEST_CELLS = 2
_PARTS = 8  # of a cell for which that does not suffice
# In an array: bounds the memory on long intervals and long chains.
_NUMBERS_AT_ONCE = 200_000


class TooLongError(Exception):
    """An interval that would take more work than is left."""


class Conditions:
    """Functions of the time s since an interval's start that must not be negative in
    it.

    One column for each sliding block (its velocity [m/s] in the direction of its mode),
    then two for each stuck block whose force can change (mu_s w - force and mu_s w +
    force [N]). `fourth` bounds the fourth derivative of each column; `computed` is the
    number of values so far.
    """

    def __init__(self, motion: ModalMotion, state: CarriedState) -> None:
        self.motion = motion
        self.mode = state.mode.copy()
        self.computed = 0
        moves = state.moves()
        near = moves.copy()
        near[0] = True
        near[1:] |= moves[:-1]
        near[:-1] |= moves[1:]
        slides = abs(state.mode) == 1
        self.sliding = np.flatnonzero(slides)
        self.stuck = np.flatnonzero(near & ~moves)
        springs = motion.modes.spring_shapes
        shapes = motion.modes.shapes[slides[moves]]
        self.to_speed = shapes.T * state.mode[self.sliding]
        self.to_force = (springs[self.stuck + 1] - springs[self.stuck]).T
        self.force = state.net_force()[self.stuck]
        self.strength = state.strength[self.stuck]
        self.rate = np.where(self.stuck == 0, state.chain.loading_rate, 0.0)
        displacement, velocity = motion.fourth_derivatives()
        bend = displacement @ np.abs(self.to_force)
        self.fourth = np.concatenate([velocity @ np.abs(self.to_speed), bend, bend])

    def __call__(self, s: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Values and slopes at the times s, each of shape (len(s), number of
        columns)."""
        displacement, velocity, acceleration = self.motion.at(s)
        force = displacement @ self.to_force + self.force + s[:, None] * self.rate
        rate = velocity @ self.to_force + self.rate
        values = [
            velocity @ self.to_speed,
            self.strength - force,
            self.strength + force,
        ]
        slopes = [acceleration @ self.to_speed, -rate, rate]
        return np.concatenate(values, axis=1), np.concatenate(slopes, axis=1)

    def broken(self, column: int) -> tuple[str, str]:
        """Sentence and unit for a column that is negative."""
        n = len(self.sliding)
        if column < n:
            i = self.sliding[column]
            return f"block {i + 1} slides against its mode {self.mode[i]:+d} at", "m/s"
        way, k = divmod(column - n, len(self.stuck))
        direction = "backward" if way else "forward"
        block = self.stuck[k] + 1
        return f"block {block} is stuck, pushed {direction} beyond mu_s w by", "N"

    def lowest(
        self, duration: float, tolerance: FloatArray, most: int
    ) -> tuple[FloatArray, FloatArray]:
        """Lowest values that were found and their times, each of shape (number of
        columns,).

        Where none is below -tolerance, none is below -2 tolerance anywhere in the
        interval. The proof: with a fourth derivative of at most M, g is off by at most
        M d^4/384 on a cell of width d from the cubic that has its values and slopes at
        both ends, and a cubic is above the least of its Bernstein coefficients. A cell
        for which that does not suffice is cut. The search ends where something is below
        -tolerance, or in a `TooLongError` at so many values computed.
        """
        columns = len(self.fourth)
        fastest = self.motion.modes.frequencies.max(initial=0.0)
        # A cell of a radian of the fastest mode can usually be proved.
        n_cells = max(_FEWEST_CELLS, math.ceil(duration * fastest)) if fastest else 1
        at_once = max(_FEWEST_CELLS, _NUMBERS_AT_ONCE // columns)
        lowest = np.full(columns, np.inf)
        when = np.zeros(columns)
        for k in range(0, n_cells, at_once):
            # A row holds one edge of all cells, the next row the other.
            edges = (
                duration
                / n_cells
                * np.arange(k, min(k + at_once, n_cells) + 1, dtype=float)[:, None]
            )
            while edges.size and not np.any(lowest < -tolerance):
                self.computed += edges.size * columns
                if self.computed > most:
                    raise TooLongError(
                        f"the audit ends here: it cannot look at {duration:.3g} s of "
                        f"sliding, {duration * fastest:.3g} radians of the fastest mode"
                    )
                times = edges.ravel()
                values, slopes = self(times)
                row = np.argmin(values, axis=0)
                value = values.min(axis=0)
                when = np.where(value < lowest, times[row], when)
                lowest = np.where(value < lowest, value, lowest)
                shape = (*edges.shape, columns)
                width = np.diff(edges, axis=0)[..., None]
                bound = lower_bound(
                    width, values.reshape(shape), slopes.reshape(shape), self.fourth
                )
                is_open = np.any(bound < -2 * tolerance, axis=-1)
                edges = np.linspace(edges[:-1][is_open], edges[1:][is_open], _PARTS + 1)
        return lowest, when


def lower_bound(
    width: FloatArray, values: FloatArray, slopes: FloatArray, fourth: FloatArray
) -> FloatArray:
    """Bound functions from below in cells, from their values and slopes at both
    edges."""
    low = values[:-1]
    high = values[1:]
    inner = np.minimum(low + slopes[:-1] * (width / 3), high - slopes[1:] * (width / 3))
    return np.minimum(np.minimum(low, high), inner) - fourth * (width**4 / 384)
