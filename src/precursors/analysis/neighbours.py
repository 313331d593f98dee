"""Runs that are rounded otherwise than a given one, and where they may take another way.

Roundings of the parameters and of each transition are drawn at random and carried along as differences.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from precursors.analysis.tangent import IntArray, Tangent
from precursors.model.chain import FloatArray
from precursors.solver.plain import ROUNDINGS
from precursors.solver.run import Run

EPS = float(np.finfo(float).eps)
# The spread of so many neighbours is within 40 % of that of very many, nineteen times in twenty.
N_NEIGHBOURS = 16
# An error is taken for so many times the spread.
SIGMAS = 3.0
# Standard deviation of one rounding, relative to what is rounded: its largest value.
ROUNDING = EPS / 2
# Near misses are looked for at points so far apart [time units]; no frequency is above 2 per time unit.
SAMPLING = 0.5
HALVINGS = 4
# Points of a block looked at at a time, which bounds the memory in long intervals.
POINTS_AT_ONCE = 40_000
# Random numbers are drawn for so many transitions at a time.
DRAWN = 64
SEED = 2010


class Unknown(NamedTuple):
    """From what time [s] on the order of transitions is unknown, and what is not known then."""

    time: float
    reason: str


def spread(differences: FloatArray) -> float:
    """Root mean square of the differences."""
    return float(np.sqrt(differences @ differences / len(differences)))


class Neighbours:
    """Runs that are rounded otherwise, as differences from the run itself at its own transitions."""

    def __init__(self, run: Run) -> None:
        chain, n = run.chain, run.chain.n_blocks
        self.run, self.tangent, self.n_blocks = run, Tangent(run), n
        self.motion, self.path = self.tangent.motion, self.tangent.path
        self.times = np.append(0.0, run.transitions["time"])
        self.random = np.random.default_rng(SEED)
        # Eq. 7 adds two numbers: a small weight is rounded like its difference from the mean.
        size = np.where(chain.weights > 0, chain.weights + abs(chain.weights - chain.normal_load / n), 0.0)
        weight = self._draw(n) * (size / np.sqrt(chain.mass))[:, None]
        mu_s, mu_k, stiffness, drive_stiffness, mass, speed = self._draw(6)
        self.strength = chain.mu_s * weight + np.outer(self.motion.strength, mu_s)
        self.friction = chain.mu_k * weight + np.outer(self.motion.friction, mu_k)
        # Momenta are the same whatever the mass is: it changes forces as a softer spring does.
        self.coupling = np.repeat((stiffness - mass)[None], n, axis=0)
        self.coupling[0] = drive_stiffness - mass
        self.drive = (drive_stiffness + speed) * self.motion.drive
        reach = abs(run.start_positions)
        forces = np.sqrt(chain.springs) * (reach + np.append(0, reach[:-1]))
        self.z = self._draw(2 * n) * np.append(forces, self.path.state[0, n:])[:, None]
        self.clock = np.zeros(N_NEIGHBOURS)
        self.rounding = self._roundings()
        self.drawn: FloatArray

    def _draw(self, *shape: int) -> FloatArray:
        return ROUNDING * self.random.standard_normal((*shape, N_NEIGHBOURS))

    def _roundings(self) -> FloatArray:
        """Size of what is rounded before each transition, (n, 2 N).

        Each window of one time unit rounds the forces in springs that move, and velocities, which are sums
        over forces.
        """
        path, motion, n = self.path, self.motion, self.n_blocks
        slides, span = path.mode[:-1] != 0, path.span[:-1, None]
        moves = slides.copy()
        moves[:, 1:] |= slides[:, :-1]
        moves[:, 0] = True
        force, velocity = abs(path.state[1:, :n]), abs(path.state[:, n:])
        pushes = force @ abs(motion.coupling) + motion.friction
        speed = np.maximum(velocity[1:], velocity[:-1]) + np.minimum(span, motion.time_unit) * pushes
        windows = np.where(slides.any(axis=1, keepdims=True), np.maximum(span / motion.time_unit, 1.0), 1.0)
        return np.hstack([moves * force, slides * speed]) * np.sqrt(windows)

    def advance(self, k: int) -> Unknown | None:
        """Carry the differences to transition k; return what is not known then, if anything."""
        path, motion, n, number = self.path, self.motion, self.n_blocks, k - self.path.n_started
        if number % DRAWN == 0:
            # As wide as the solver's arrays, with a drive and a free end, so that published errors stay.
            drawn = self._draw(DRAWN, 2, n + 2)[:, :, 1:-1]
            self.drawn = drawn.reshape((DRAWN, 2 * n, N_NEIGHBOURS))
        span = float(path.span[k])
        z = self.z = motion.after(path.mode[k], self.z, span, self.friction)
        z[:n] += self.coupling * (path.state[k + 1, :n] - path.state[k, :n])[:, None]
        z[0] += self.drive * span
        z += self.drawn[number % DRAWN] * self.rounding[k][:, None]
        interval = self.tangent.meet(k, z, self.strength)
        self.clock += interval
        block, error = int(path.block[k]), SIGMAS * spread(interval)
        if not error < span:
            return Unknown(float(self.times[k]), f"whether block {block + 1} is the next to change its state")
        # An event function that hardly goes below zero may not do so at all.
        depth = path.slope[k] ** 2 / (2.0 * path.bend[k]) if path.bend[k] > 0 else np.inf
        if not error * -path.slope[k] + self._resolution(k + 1, block, bool(path.old[k])) < depth:
            return Unknown(float(self.times[k]), f"whether block {block + 1} changes its state")
        if path.old[k] and not self._sticking_is_known(block, k + 1):
            return Unknown(float(self.times[k + 1]), f"whether block {block + 1} sticks or turns round")
        return None

    def unknown_at_start(self) -> Unknown | None:
        """Return which block may or may not be set in motion by the springs at time 0."""
        at_rest = self.path.state[0, self.n_blocks :] == 0.0
        for block in np.flatnonzero(at_rest).tolist() if self.run.start_positions.any() else ():
            if not self._sticking_is_known(block, 0):
                return Unknown(0.0, f"whether block {block + 1} sticks")
        return None

    def unknown_after(self, row: int) -> Unknown | None:
        """Return the closest near miss between a row of the path and the next, if it is within the error."""
        if not self.path.mode[row].any():
            return None
        miss = self._nearest_miss(row)
        if miss is None:
            return None
        by, since, block, slides = miss
        reach = 1.0 if slides else float(np.linalg.norm(self.motion.coupling[:, block]))
        error = SIGMAS * self.tangent.size(row, self.z) * reach + self._resolution(row, block, slides)
        if not slides:
            error += SIGMAS * ROUNDING * float(self.motion.strength[block])
        if error < by:
            return None
        return Unknown(float(self.times[row]) + since, f"whether block {block + 1} changes its state")

    def _sticking_is_known(self, block: int, row: int) -> bool:
        """Whether the net force on a block differs from its strength by more than the error."""
        force = self.motion.net_force(self.path.state[row])[block]
        wrong = abs(self.strength[block]) + abs(self.motion.net_force(self.z.T)[:, block])
        error = SIGMAS * spread(wrong) + self._resolution(row, block, slides=False)
        return bool(error < abs(self.motion.strength[block] - abs(force)))

    def _resolution(self, row: int, block: int, slides: bool) -> float:
        """Value below which the solver may take an event function for zero, next to a row of the path."""
        n, motion, unit = self.n_blocks, self.motion, self.motion.time_unit
        squares = motion.coupling[:, block] ** 2
        force = abs(self.path.state[row, :n]) @ abs(motion.coupling[:, block])
        # The solver bounds speeds by the sum of all terms of their series.
        speed = abs(self.path.state[max(row - 1, 0) : row + 1, n:]).max(axis=0)
        behind = speed[block - 1] if block else motion.drive / motion.coupling[0, 0]
        moving = unit * squares[block] * behind + speed[block] / unit
        if block + 1 < n:
            moving += unit * squares[block + 1] * speed[block + 1]
        value = 2.0 * ROUNDINGS * (2.0 * (force + motion.strength[block]) + moving)
        return float(value * unit if slides else value)

    def _nearest_miss(self, row: int) -> tuple[float, float, int, bool] | None:
        """The event function that comes closest to zero without crossing it, after a row of the path.

        Returns its value over the change by a difference of norm 1, the time since the row [s], the block
        from 0, and whether it slides. A shift in time does not change a least value.
        """
        span, spacing = float(self.path.span[row]), SAMPLING * self.motion.time_unit
        cells = max(int(np.ceil(span / spacing)), 1)
        norms = np.append(np.ones(self.n_blocks), np.linalg.norm(self.motion.coupling, axis=0))
        closest, least = None, np.inf
        at_once = max(POINTS_AT_ONCE // self.n_blocks, 1)
        for begin in range(0, cells, at_once):
            times = np.arange(begin, min(begin + at_once, cells) + 1, dtype=np.float64) * (span / cells)
            _, slope, _ = self._event_functions(row, times)
            at, which = np.nonzero((slope[:-1] < 0.0) & (slope[1:] > 0.0))
            if not at.size:
                continue
            value, since = self._least_values(row, which, times[at], times[at + 1])
            i = int(np.argmin(value / norms[which]))
            if value[i] / norms[which[i]] < least:
                least = value[i] / norms[which[i]]
                block, slides = int(which[i]) % self.n_blocks, bool(which[i] < self.n_blocks)
                closest = float(value[i]), float(since[i]), block, slides
        return closest

    def _least_values(
        self, row: int, which: IntArray, start: FloatArray, end: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """Least values of event functions between times where each falls and then rises, and just when."""
        for _ in range(HALVINGS):
            middle = (start + end) / 2.0
            value, slope, bend = (x[np.arange(len(which)), which] for x in self._event_functions(row, middle))
            start, end = np.where(slope < 0.0, middle, start), np.where(slope < 0.0, end, middle)
        with np.errstate(divide="ignore", invalid="ignore"):
            below = np.where(bend > 0.0, slope**2 / (2.0 * bend), 0.0)
        return value - np.minimum(below, abs(slope) * (end - start)), start

    def _event_functions(self, row: int, times: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Event functions with their first two derivatives at times since a row [s], each (len(times), 2 N).

        The first N are the speeds of the sliding blocks, the others how far the forces on stuck ones are from
        their strengths; NaN where a block has no such function.
        """
        n, motion, mode = self.n_blocks, self.motion, self.path.mode[row]
        start, friction = self.path.state[row][:, None], motion.friction[:, None]
        z = motion.after(mode, start, times, friction, motion.drive).T
        rate = motion.rate(mode, z)
        states = z, rate, motion.derivative(mode, rate)
        sliding, stuck = np.where(mode != 0, mode, np.nan), np.where(mode == 0, 1.0, np.nan)
        value, slope, bend = (
            np.hstack([sliding * x[:, n:], -stuck * np.sign(motion.net_force(z)) * motion.net_force(x)])
            for x in states
        )
        value[:, n:] += motion.strength
        return value, slope, bend
