"""How many digits of a run are right: its rounding, carried along by the linearised motion.

A few neighbouring runs start from parameters rounded another way and suffer other roundings of the same size
at each transition; how far apart their clocks come is how far a clock can be trusted. The order of
transitions is lost where two of them, or a transition and one only just missed, are closer than that.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from precursors.analysis.tangent import IntArray, Tangent, Trajectory, rates, states_at, trajectory_of
from precursors.model.chain import FloatArray, positive
from precursors.solver import kernel
from precursors.solver.kernel import System
from precursors.solver.run import Run

EPS = float(np.finfo(float).eps)
# The spread of so many neighbours is within 40 % of that of very many, nineteen times in twenty.
N_NEIGHBOURS = 16
# An error is taken for so many times the spread.
SIGMAS = 3.0
# Standard deviation of one rounding that counts, relative to what is rounded: its largest value.
ROUNDING = EPS / 2
# Near misses are looked for at points so far apart [tau]; no frequency of the chain is above 2.
SAMPLING = 0.5
HALVINGS = 4
# Random numbers are drawn for so many transitions at a time.
DRAWN = 64
SEED = 2010


class Lost(NamedTuple):
    """When the order of transitions ceases to be known [s], and what is not known then."""

    time: float
    reason: str


NEVER = Lost(np.inf, "")


@dataclass(frozen=True, eq=False)
class ErrorGrowth:
    """How far the transitions of a run hold.

    Attributes
    ----------
    time : array, shape (n_transitions,)
        Times of the transitions [s].
    time_error : array, shape (n_transitions,)
        Error of each time [s]; infinite where the order of transitions is lost.
    duration : float
        Time that the run reached [s].
    lost : Lost
        Where the order of transitions is lost; `NEVER` if it is known for all of the run.
    """

    time: FloatArray
    time_error: FloatArray
    duration: float
    lost: Lost

    def horizon(self, tolerance: float) -> float:
        """Time [s] up to which the order is right, and each transition's time to `tolerance` [s].

        Raises
        ------
        ValueError
            If the tolerance is not positive.
        """
        positive("tolerance", tolerance, "s")
        wrong = np.flatnonzero((self.time_error > tolerance) & np.isfinite(self.time_error))
        first = np.inf
        if wrong.size:
            # It may have come before, by its error, but not before the last one that holds.
            k = int(wrong[0])
            first = max(self.time[k] - self.time_error[k], self.time[k - 1] if k else 0.0)
        return float(min(first, self.lost.time, self.duration))


def error_growth(run: Run) -> ErrorGrowth:
    """Estimate the error of every transition's time, and where the order of transitions is lost.

    Counted is the rounding that `simulate` commits, and that of the parameters, taken for numbers rounded to
    double precision. It is an estimate and no proof (`certify` gives one): linear, with roundings drawn at
    random, but always the same. A run and its continuation have the same errors as far as both go.

    Raises
    ------
    ValueError
        If the run has no stored states.
    """
    system = kernel.scale(run.chain)
    path = trajectory_of(run, system)
    time = run.transitions["time"].astype(np.float64)
    error = np.full(len(time), np.inf)
    error[: path.n_started] = 0.0
    near_misses = _near_misses(run, system, path)
    neighbours = _Neighbours(run, system, path)
    lost = neighbours.doubt_at_start() or neighbours.doubt_of(near_misses.get(path.n_started), path.n_started)
    for k in range(path.n_started, len(time)):
        lost = lost or neighbours.advance(k)
        if lost:
            break
        error[k] = SIGMAS * _spread(neighbours.clock) + EPS * time[k]
        lost = neighbours.doubt_of(near_misses.get(k + 1), k + 1)
    lost = lost or NEVER
    error[time >= lost.time] = np.inf
    return ErrorGrowth(time, error, run.duration, lost)


class _Neighbours:
    """Runs rounded otherwise, as differences from the run itself at its own transitions."""

    def __init__(self, run: Run, system: System, path: Trajectory) -> None:
        chain, n = run.chain, run.chain.n_blocks
        self.run, self.system, self.path, self.tangent = run, system, path, Tangent(system, path)
        self.random = np.random.default_rng(SEED)
        # Eq. 7 adds two numbers, so that a small weight is rounded like its difference from the mean.
        size = np.where(chain.weights > 0, chain.weights + abs(chain.weights - chain.normal_load / n), 0.0)
        weight = self._draw(n) * size[:, None]
        mu_s, mu_k, stiffness, drive_stiffness, mass, speed = self._draw(6)
        self.strength, self.friction = np.zeros((2, n + 1, N_NEIGHBOURS))
        self.strength[1:] = chain.mu_s * weight + np.outer(chain.strength, mu_s)
        self.friction[1:] = chain.mu_k * weight + np.outer(chain.kinetic_friction, mu_k)
        # Forces grow with the stiffnesses, in the unit of time, which is rounded with the mass.
        self.coupling = np.repeat((stiffness - mass)[None], n, axis=0)
        self.coupling[0] = drive_stiffness - mass
        self.drive = (drive_stiffness + speed) * system.coupling[1] * system.drive_velocity
        reach = abs(run.start_positions)
        start = np.concatenate(
            [chain.springs * (reach + np.append(0, reach[:-1])), path.state[0, n + 3 : -1]]
        )
        self.state = np.zeros((2 * n + 4, N_NEIGHBOURS))
        self.state[np.r_[1 : n + 1, n + 3 : 2 * n + 3]] = self._draw(2 * n) * start[:, None]
        self.clock = np.zeros(N_NEIGHBOURS)
        self.rounding = _roundings(system, path)
        self.drawn = np.empty(0)

    def _draw(self, *shape: int) -> FloatArray:
        return ROUNDING * self.random.standard_normal((*shape, N_NEIGHBOURS))

    def advance(self, k: int) -> Lost | None:
        """Carry the differences to transition k; return what is not known then, if anything."""
        path, n, state, number = self.path, self.tangent.n_blocks, self.state, k - self.path.n_started
        if number % DRAWN == 0:
            self.drawn = self._draw(DRAWN, 2 * n + 4)
        self.tangent.slide(k, state, self.friction)
        change = path.state[k + 1, 1 : n + 1] - path.state[k, 1 : n + 1]
        state[1 : n + 1] += self.coupling * change[:, None]
        state[1] += self.drive * path.span[k]
        state += self.drawn[number % DRAWN] * self.rounding[k][:, None]
        interval = self.tangent.meet(k, state, self.strength)
        self.clock += interval * self.system.tau
        block, error = int(path.block[k]), SIGMAS * _spread(interval)
        before = float(self.run.transitions["time"][k - 1]) if k else 0.0
        if not error < path.span[k]:
            return Lost(before, f"whether block {block} is the next to change its state")
        # A gauge that hardly goes below zero may not do so at all.
        depth = path.slope[k] ** 2 / (2.0 * path.bend[k]) if path.bend[k] > 0 else np.inf
        if not error * -path.slope[k] + _grain(self.system, path, k + 1, block) < depth:
            return Lost(before, f"whether block {block} changes its state")
        if path.old[k] and not self._margin_is_known(block, k + 1):
            return Lost(
                float(self.run.transitions["time"][k]), f"whether block {block} sticks or turns round"
            )
        return None

    def doubt_at_start(self) -> Lost | None:
        """Return which block may or may not be set in motion by the springs at time 0."""
        n = self.tangent.n_blocks
        if self.run.start_positions.any():
            for block in range(1, n + 1):
                if self.path.state[0, n + 2 + block] == 0.0 and not self._margin_is_known(block, 0):
                    return Lost(0.0, f"whether block {block} sticks")
        return None

    def _margin_is_known(self, block: int, row: int) -> bool:
        """Whether the net force on a block differs from its strength by more than the error."""
        force = self.path.state[row]
        margin = abs(self.system.strength[block] - abs(force[block] - force[block + 1]))
        wrong = abs(self.strength[block]) + abs(self.state[block] - self.state[block + 1])
        return bool(SIGMAS * _spread(wrong) + _grain(self.system, self.path, row, block) < margin)

    def doubt_of(self, miss: _NearMiss | None, row: int) -> Lost | None:
        """Return the near miss after a row of the path, if it is within the error."""
        if miss is None:
            return None
        error = SIGMAS * (self.tangent.size(row, self.state) * miss.reach + ROUNDING * miss.strength)
        error += _grain(self.system, self.path, row, miss.block)
        return None if error < miss.by else Lost(miss.time, f"whether block {miss.block} changes its state")


def _spread(differences: FloatArray) -> float:
    return float(np.sqrt(differences @ differences / len(differences)))


def _grain(system: System, path: Trajectory, row: int, block: int) -> float:
    """Value below which the solver may take a gauge of a block for zero, next to a row (`kernel.grain`)."""
    n = path.mode.shape[1]
    force = abs(path.state[row, block : block + 2])
    speed = abs(path.state[max(row - 1, 0) : row + 1, n + block + 1 : n + block + 4]).max(axis=0)
    still = force.sum() + system.strength[block]
    moving = system.coupling[block] * speed[0] + speed[1] + system.coupling[block + 1] * speed[2]
    # The solver bounds speeds by the sum of all terms of their series.
    return float(2.0 * kernel.ROUNDINGS * (2.0 * still + moving))


def _roundings(system: System, path: Trajectory) -> FloatArray:
    """Size of what is rounded before each transition, (n, 2 N + 4): forces [N], velocities [N/tau].

    Each window of one tau rounds the forces in springs that move, and velocities that are sums over forces.
    """
    n = path.mode.shape[1]
    force, velocity = np.split(abs(path.state[1:]), 2, axis=1)
    slides = np.pad(path.mode[:-1] != 0, ((0, 0), (1, 1)))
    size = np.zeros_like(path.rate)
    moves = slides[:, 1:-1] | slides[:, :-2]
    moves[:, 0] = True
    size[:, 1 : n + 1] = moves * force[:, 1:-1]
    pushes = force[:, 1:-1] + force[:, 2:] + system.friction[1 : n + 1]
    speed = np.maximum(velocity, abs(path.state[:-1, n + 2 :]))[:, 1:-1]
    size[:, n + 3 : -1] = slides[:, 1:-1] * (speed + np.minimum(path.span, 1.0)[:, None] * pushes)
    windows = np.where(slides.any(axis=1), np.maximum(path.span, 1.0), 1.0)
    return size * np.sqrt(windows)[:, None]


class _NearMiss(NamedTuple):
    """A gauge that came close to zero: by how much, at what time [s], of which block.

    A difference of unit energy norm changes it by `reach`; the rounding of `strength` [N] enters as it is.
    """

    by: float
    time: float
    block: int
    reach: float
    strength: float


def _near_misses(run: Run, system: System, path: Trajectory) -> dict[int, _NearMiss]:
    """Closest miss in each interval, by the row of the path before it.

    Looks at the least value, between transitions, of the velocity of each sliding block and of the margin of
    each stuck one beside it. A shift in time does not change a least value.
    """
    n = path.mode.shape[1]
    ends = np.append(0.0, run.transitions["time"])
    known = np.flatnonzero(path.mode.any(axis=1) & (np.arange(len(ends)) >= path.n_started))
    lengths = run.intervals[known]
    points = np.ceil(lengths / (SAMPLING * system.tau)).astype(int).clip(1) + 1
    row = np.repeat(known, points)
    place = np.arange(len(row)) - np.repeat(np.cumsum(points) - points, points)
    time = np.minimum(ends[row] + place * np.repeat(lengths / (points - 1), points), run.duration)
    _, slope, _ = _gauges(run, system, path.mode[row], time)
    falls_and_rises = (row[1:] == row[:-1])[:, None] & (slope[:-1] < 0.0) & (slope[1:] > 0.0)
    at, gauge = np.nonzero(falls_and_rises)
    value, when = _least_values(run, system, path.mode[row[at]], gauge, time[at], time[at + 1])
    block = gauge % n + 1
    is_margin = gauge >= n
    reach = np.where(is_margin, np.sqrt(system.coupling[block] + system.coupling[block + 1]), 1.0)
    closest: dict[int, _NearMiss] = {}
    for i in np.argsort(-value / reach).tolist():
        strength = float(system.strength[block[i]]) if is_margin[i] else 0.0
        closest[int(row[at[i]])] = _NearMiss(
            float(value[i]), float(when[i]), int(block[i]), float(reach[i]), strength
        )
    return closest


def _least_values(
    run: Run, system: System, mode: IntArray, gauge: IntArray, start: FloatArray, end: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Least value of a gauge between two times [s], where it falls and then rises, and a time just before."""
    for _ in range(HALVINGS):
        middle = (start + end) / 2.0
        value, slope, bend = (x[np.arange(len(gauge)), gauge] for x in _gauges(run, system, mode, middle))
        start, end = np.where(slope < 0.0, middle, start), np.where(slope < 0.0, end, middle)
    with np.errstate(divide="ignore", invalid="ignore"):
        below = np.where(bend > 0.0, slope**2 / (2.0 * bend), 0.0)
    return value - np.minimum(below, abs(slope) * (end - start) / system.tau), start


def _gauges(
    run: Run, system: System, mode: IntArray, time: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Velocities of sliding blocks and margins of stuck ones, their rates and second derivatives.

    Each (len(time), 2 N); a block that slides has no margin, and one that sticks no velocity: NaN.
    """
    n = mode.shape[1]
    state = states_at(run, system, time)
    rate = rates(system, mode, state)
    bend = rates(system, mode, rate, 0.0)
    sliding, stuck = np.where(mode != 0, mode, np.nan), np.where(mode == 0, 1.0, np.nan)

    def net(x: FloatArray) -> FloatArray:
        return x[:, 1 : n + 1] - x[:, 2 : n + 2]

    side = stuck * np.sign(net(state))
    velocities = [sliding * x[:, n + 3 : -1] for x in (state, rate, bend)]
    margins = [system.strength[1 : n + 1] - side * net(state), -side * net(rate), -side * net(bend)]
    value, slope, curvature = (np.hstack(pair) for pair in zip(velocities, margins, strict=True))
    return value, slope, curvature
