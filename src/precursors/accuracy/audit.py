"""An independent check that a run is a motion of the model: equation of motion, Coulomb's law, energy.

Nothing of the solver is used. Every interval between two transitions is propagated by the normal modes of
the sliding blocks, and what must hold inside it is proved with a bound on the fourth derivative.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np
from scipy.linalg import svd

from precursors.model.chain import Chain, FloatArray, not_negative, positive, require_plain

if TYPE_CHECKING:
    from precursors.solver.run import Run

FORCE_TOLERANCE = 1e-10
"""Of the largest strength mu_s w. Rounding in solver and auditor adds up to 1e-13 in the paper's 10 s, to
3e-11 in 3000 transitions of a chain 1e6 times stiffer than its drive; a release that is late by 1e-9 s is
off by 2e-9, because the drive loads the paper's chain by 80 N/s."""

VELOCITY_TOLERANCE = 1e-10
"""Of mu_s w/sqrt(K m) (k if it is softer), the speed a strength gives a block on its softest spring. Rounding
adds up to 1e-14; mu_k wrong by 1e-9 shows as some 1e-10."""

TIME_TOLERANCE = 1e-12
"""Of the duration: recorded times are rounded once a transition, the intervals are not."""

ENERGY_TOLERANCE = 1e-10
"""Of the largest of the work of the drive, the friction heat, the energy at the start and that of all blocks
at the speed of the drive."""

MAX_PROBLEMS = 20
"""The audit stops at this many: what follows a wrong transition is wrong, and says nothing new."""

_UNIT = 2.0**-53  # a rounding, relative
_START_ROUNDINGS = 8
_PHASE_PER_CELL = 1.0  # rad of the fastest mode: what a first cell can usually be proved for
_FEWEST_CELLS = 2
_PARTS = 8  # of a cell for which that does not suffice
_PROBES_AT_ONCE = 200_000  # numbers per array: bounds the memory on long intervals and long chains
_MODES_KEPT = 2e8  # bytes


@dataclass(frozen=True)
class Tolerances:
    """What an audit lets pass, each relative to its scale (see the constants of this module).

    Parameters
    ----------
    force, velocity, time, energy : float
        Fractions of the largest strength, of mu_s w/sqrt(K m), of the duration and of the energy turned over.
    roundings : float
        Not 0: forces and velocities may be off by so many roundings of a step (see `_Rounding`), instead of
        by fixed fractions. Of an exact run it is 16, which is what the solver counts as zero.

    Raises
    ------
    ValueError
        If `roundings` is not a finite number from zero on, or another is not a finite number above zero.
    """

    force: float = FORCE_TOLERANCE
    velocity: float = VELOCITY_TOLERANCE
    time: float = TIME_TOLERANCE
    energy: float = ENERGY_TOLERANCE
    roundings: float = 0.0

    def __post_init__(self) -> None:
        object.__setattr__(self, "roundings", not_negative("tolerance roundings", self.roundings, "1"))
        for name in ("force", "velocity", "time", "energy"):
            object.__setattr__(self, name, positive(f"tolerance {name}", getattr(self, name), "1"))


@dataclass(frozen=True)
class Audit:
    """Outcome of an audit.

    Parameters
    ----------
    velocity_violation, velocity_violation_relative : float
        Largest speed of a sliding block against its mode [m/s], and relative to its scale.
    stick_violation, stick_violation_relative : float
        Largest excess of a stuck block's force over mu_s w [N], and relative to its scale.
    transition_residual : float
        Largest deviation from the switching rule and from the recorded load, relative.
    time_residual : float
        Largest difference of a recorded time and the sum of the intervals [s].
    energy_residual : float
        Work of the drive minus change of energy minus friction heat, relative.
    roundings : float
        Largest deviation of a force or a velocity, in roundings.
    n_intervals : int
        Number of intervals that were propagated.
    problems : tuple of str
        What exceeds its tolerance, one short sentence each, at most `MAX_PROBLEMS`.
    """

    velocity_violation: float
    velocity_violation_relative: float
    stick_violation: float
    stick_violation_relative: float
    transition_residual: float
    time_residual: float
    energy_residual: float
    roundings: float
    n_intervals: int
    problems: tuple[str, ...]

    @property
    def ok(self) -> bool:
        """Whether the run is a motion of the model within the tolerances."""
        return not self.problems

    def raise_if_failed(self) -> None:
        """Raise an ArithmeticError that lists the problems, if there are any."""
        if self.problems:
            raise ArithmeticError(str(self))

    def __str__(self) -> str:
        verdict = "a motion" if self.ok else f"no motion ({len(self.problems)} problems)"
        return "\n".join(
            [
                f"The run is {verdict} of the model: {self.n_intervals} intervals audited.",
                f"  velocity against its mode  {self.velocity_violation:.1e} m/s"
                f" (relative {self.velocity_violation_relative:.1e})",
                f"  force beyond mu_s w        {self.stick_violation:.1e} N"
                f" (relative {self.stick_violation_relative:.1e})",
                f"  transitions, loads         {self.transition_residual:.1e} relative",
                f"  recorded times             {self.time_residual:.1e} s",
                f"  energy                     {self.energy_residual:.1e} relative",
                *self.problems,
            ]
        )


def audit(run: Run, tolerance: Tolerances | float | None = None) -> Audit:
    """Check that a run is a motion of the chain, without the solver's code.

    From the start state, the transitions are applied in order and every interval is propagated by the modes
    of the sliding blocks. Inside each interval sliding blocks must keep the direction of their mode and
    stuck blocks must stay within +-mu_s w: excesses of more than the tolerance are reported where they are
    probed, and a bound proves that none of more than twice the tolerance exists between the probes. At each
    transition the switching rule, the recorded load and the recorded time are checked; at the end the energy.

    Parameters
    ----------
    run : Run
        Of any method: only chain, start state, transitions, intervals and duration are read.
    tolerance : Tolerances or float, optional
        A number holds for force, velocity, time and energy alike; the defaults are those of an exact run.

    Returns
    -------
    Audit

    Raises
    ------
    ValueError
        If a tolerance is not a number above zero, or the chain has viscosity, interface springs or a head.
    """
    require_plain(run.chain)
    if tolerance is None:
        tolerance = Tolerances()
    elif not isinstance(tolerance, Tolerances):
        tolerance = Tolerances(tolerance, tolerance, tolerance, tolerance)
    malformed = _malformed(run)
    if malformed:
        nan = math.nan
        return Audit(nan, nan, nan, nan, nan, nan, nan, nan, n_intervals=0, problems=(malformed,))
    return _Auditor(run, tolerance).audit()


def _malformed(run: Run) -> str:
    """Say why the arrays of a run cannot be audited at all, or nothing."""
    n, n_transitions = run.chain.n_blocks, len(run.transitions)
    for name in ("start_positions", "start_velocities"):
        start = np.asarray(getattr(run, name))
        if start.shape != (n,) or not np.all(np.isfinite(start)):
            return f"{name} does not hold one finite value for each of the {n} blocks"
    intervals = np.asarray(run.intervals)
    if intervals.shape != (n_transitions + 1,):
        return (
            f"{n_transitions} transitions need {n_transitions + 1} intervals, the run has {intervals.shape}"
        )
    if not (np.all(np.isfinite(intervals)) and np.all(intervals >= 0)):
        return "an interval is negative or not finite"
    block, mode = run.transitions["block"], run.transitions["mode"]
    wrong = np.flatnonzero((block < 1) | (block > n) | (mode < -1) | (mode > 1))
    if wrong.size:
        k = wrong[0]
        return f"transition {k} has block {block[k]}, mode {mode[k]}: there is no such block or mode"
    return ""


@dataclass(frozen=True, eq=False)
class _Modes:
    """Normal modes of blocks that slide, between neighbours that do not move.

    frequencies (n,) [rad/s]; shapes (n blocks, n): displacement = shapes @ q; spring_shapes (n springs, n):
    the forces of the springs grow by -spring_shapes @ q.
    """

    frequencies: FloatArray
    shapes: FloatArray
    spring_shapes: FloatArray


def normal_modes(chain: Chain, first: int, last: int) -> _Modes:
    """Normal modes of the blocks first..last, counted from 0, and of the springs behind and ahead of them.

    With springs s, the stiffness matrix is B B^T, B the bidiagonal matrix of +sqrt(s_i), -sqrt(s_i+1). Its
    singular values, not the eigenvalues of the product, keep the digits of a mode that is slower than the
    fastest by orders of magnitude (soft drive), and its right vectors give the spring forces without
    differences of nearly equal displacements. LAPACK's gesvd leaves a bidiagonal matrix as it is and finds
    its singular values to high relative accuracy (Demmel & Kahan, 1990).
    """
    roots = np.sqrt(chain.springs[first : last + 2])
    n = last - first + 1
    # A last row of zeros makes B square where a spring follows the last block; it adds a frequency of zero.
    balance = np.diag(roots) - np.diag(roots[1:], 1)
    balance[n:] = 0.0
    left, singular, right = svd(balance, lapack_driver="gesvd", check_finite=False)
    singular = singular[:n]
    return _Modes(
        frequencies=singular / math.sqrt(chain.mass),
        shapes=np.ascontiguousarray(left[:n, :n]),
        spring_shapes=roots[:, None] * right[:n].T * singular,
    )


@dataclass(frozen=True, eq=False)
class _Motion:
    """Motion mode by mode: q'' + omega^2 q = push + ramp s, q = 0 and q' = speed at s = 0."""

    modes: _Modes
    speed: FloatArray
    push: FloatArray
    ramp: FloatArray

    def at(self, s: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Modal displacements, velocities and accelerations at the times s, each of shape (len(s), n)."""
        omega = self.modes.frequencies
        half = (0.5 * s)[:, None] * omega
        sine_half = np.sin(half)
        versine = 2 * sine_half**2  # 1 - cos without cancellation
        sine = 2 * sine_half * np.cos(half)
        cosine = 1 - versine
        # The difference cancels for omega s << 1, but relative to the drive's V s it keeps all digits.
        lag = s[:, None] - sine / omega
        displacement = (self.speed / omega) * sine + (self.push * versine + self.ramp * lag) / omega**2
        velocity = self.speed * cosine + (self.push / omega) * sine + (self.ramp / omega**2) * versine
        acceleration = self.push * cosine + (self.ramp / omega - self.speed * omega) * sine
        return displacement, velocity, acceleration

    def swing(self, s: float) -> FloatArray:
        """Integral of how far the modal displacements are behind equilibrium, from 0 to s, shape (n,)."""
        omega = self.modes.frequencies
        sine, versine = np.sin(omega * s), 2 * np.sin(0.5 * omega * s) ** 2
        return (self.push / omega * sine - (self.speed - self.ramp / omega**2) * versine) / omega**2

    def bounds(self) -> tuple[FloatArray, FloatArray]:
        """Largest fourth derivatives of modal displacements and velocities, each of shape (n,)."""
        omega = self.modes.frequencies
        acceleration = np.hypot(self.push, self.ramp / omega - self.speed * omega)
        return acceleration * omega**2, acceleration * omega**3

    def speed_bound(self) -> float:
        """Largest speed that all modes together can have: the root of the sum of the squares."""
        omega = self.modes.frequencies
        largest = np.abs(self.speed) + np.abs(self.push / omega) + 2 * np.abs(self.ramp / omega**2)
        return float(np.linalg.norm(largest))


class _Gauges:
    """What must not be negative in an interval, as functions of the time s since its start.

    One column for each sliding block (its velocity in the direction of its mode, over the velocity scale),
    then two for each stuck block whose force can change (mu_s w - force and mu_s w + force, over the force
    scale). `fourth` bounds the fourth derivative of each column.
    """

    def __init__(self, auditor: _Auditor, motion: _Motion) -> None:
        self.motion = motion
        moves = auditor.mode != 0
        near = moves.copy()
        near[0] = True
        near[1:] |= moves[:-1]
        near[:-1] |= moves[1:]
        self.sliding = np.flatnonzero(moves)
        self.stuck = np.flatnonzero(near & ~moves)
        self.blocks = np.concatenate([self.sliding, self.stuck, self.stuck])
        springs = motion.modes.spring_shapes
        self.to_speed = motion.modes.shapes.T * (auditor.mode[self.sliding] / auditor.velocity_scale)
        self.to_force = (springs[self.stuck + 1] - springs[self.stuck]).T / auditor.force_scale
        self.strength = auditor.strength[self.stuck] / auditor.force_scale
        self.force = auditor.net_force()[self.stuck] / auditor.force_scale
        self.rate = np.where(self.stuck == 0, auditor.chain.loading_rate / auditor.force_scale, 0.0)
        displacement, velocity = motion.bounds()
        force = displacement @ np.abs(self.to_force)
        self.fourth = np.concatenate([velocity @ np.abs(self.to_speed), force, force])

    def __call__(self, s: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Values and slopes at the times s, each of shape (len(s), number of columns)."""
        displacement, velocity, acceleration = self.motion.at(s)
        force = displacement @ self.to_force + self.force + s[:, None] * self.rate
        rate = velocity @ self.to_force + self.rate
        values = [velocity @ self.to_speed, self.strength - force, self.strength + force]
        slopes = [acceleration @ self.to_speed, -rate, rate]
        return np.concatenate(values, axis=1), np.concatenate(slopes, axis=1)

    def lowest(self, duration: float, tolerance: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Lowest values that were probed and their times, each of shape (number of columns,).

        Where none is below -tolerance, none is below -2 tolerance anywhere in the interval. The proof: with
        a fourth derivative of at most M, g is off by at most M d^4/384 on a cell of width d from the cubic
        that has its values and slopes at both ends, and a cubic is above the least of its Bernstein
        coefficients; a cell for which that does not suffice is cut. The search ends where something is
        below -tolerance.
        """
        fastest = self.motion.modes.frequencies.max(initial=0.0)
        n_cells = max(_FEWEST_CELLS, math.ceil(duration * fastest / _PHASE_PER_CELL)) if fastest else 1
        at_once = max(_FEWEST_CELLS, _PROBES_AT_ONCE // len(self.blocks))
        lowest, when = np.full(len(self.blocks), np.inf), np.zeros(len(self.blocks))
        for k in range(0, n_cells, at_once):
            edges = duration / n_cells * np.arange(k, min(k + at_once, n_cells) + 1, dtype=np.float64)
            self._search(edges, tolerance, lowest, when)
            if np.any(lowest < -tolerance):
                break
        return lowest, when

    def _search(self, edges: FloatArray, tolerance: FloatArray, lowest: FloatArray, when: FloatArray) -> None:
        """Prove the cells between the edges, or cut them into parts; lowest and when are updated."""
        values, slopes = self(edges)
        _note(values, edges, lowest, when)
        while True:
            # One row of `edges` is one edge of all cells, the next row the other.
            start, end = edges[:-1].ravel(), edges[1:].ravel()
            shape = len(start), len(self.blocks)
            low, low_slope = values[:-1].reshape(shape), slopes[:-1].reshape(shape)
            high, high_slope = values[1:].reshape(shape), slopes[1:].reshape(shape)
            bound = _lower_bound(low, low_slope, high, high_slope, (end - start)[:, None], self.fourth)
            open_cells = np.flatnonzero(np.any((bound < -2 * tolerance) & (lowest >= -tolerance), axis=1))
            if not open_cells.size:
                return
            edges = np.linspace(start[open_cells], end[open_cells], _PARTS + 1)
            inner = edges[1:-1].ravel()
            inner_values, inner_slopes = self(inner)
            _note(inner_values, inner, lowest, when)
            parts = _PARTS - 1, *low[open_cells].shape
            values = np.vstack([low[None, open_cells], inner_values.reshape(parts), high[None, open_cells]])
            slopes = np.vstack(
                [low_slope[None, open_cells], inner_slopes.reshape(parts), high_slope[None, open_cells]]
            )


def _lower_bound(
    low: FloatArray,
    low_slope: FloatArray,
    high: FloatArray,
    high_slope: FloatArray,
    width: FloatArray,
    fourth: FloatArray,
) -> FloatArray:
    """Bound g from below on cells of a width: values and slopes at both ends, largest fourth derivative."""
    inner = np.minimum(low + low_slope * (width / 3), high - high_slope * (width / 3))
    return np.minimum(np.minimum(low, high), inner) - fourth * (width**4 / 384)


def _note(values: FloatArray, times: FloatArray, lowest: FloatArray, when: FloatArray) -> None:
    """Keep the lowest value of each column and its time."""
    row = np.argmin(values, axis=0)
    value = values[row, np.arange(values.shape[1])]
    deeper = value < lowest
    lowest[deeper], when[deeper] = value[deeper], times[row[deeper]]


class _Rounding:
    """What rounding may have done so far to forces and velocities, in the solver and here.

    Both carry spring forces f and velocities v in doubles. Each step rounds them by some units of 2^-53 of
    the largest they can be, in the norm sum f_i^2/k_i + m v_i^2, twice the energy: a step is a transition, or
    a radian of the fastest motion, and the drive counts as a mass that moves. In this norm the difference of
    two motions with the same transitions does not grow: springs and masses keep it, and what stops loses it.
    So roundings add up: those of an interval one by one, as they may all go the same way (that of a
    frequency does), those of different intervals as squares. One rounding a step comes to `total` [sqrt(J)],
    which is total/sqrt(m) of a velocity and total sqrt(k) of the force of a spring. Positions at the start,
    of which forces are the differences, are sums over springs: known to `_START_ROUNDINGS` of theirs.
    """

    def __init__(self, run: Run) -> None:
        chain, positions = run.chain, np.asarray(run.start_positions, dtype=float)
        ends = positions**2 + np.append(0.0, positions[:-1]) ** 2
        self.total = _START_ROUNDINGS * _UNIT * math.sqrt(float(chain.springs @ ends))
        self.fastest = 2 * math.sqrt(chain.springs.max() / chain.mass)
        self.root_mass = math.sqrt(chain.mass)
        self.root_springs = np.sqrt(np.append(chain.springs, 0.0))
        self.drive = self.root_mass * chain.drive_velocity
        self.total += _UNIT * self.drive
        self.most = 0.0

    def add(self, duration: float, motion: _Motion, energy: float) -> None:
        """Add one rounding for each step of an interval, at whose ends the chain has at most this energy."""
        steps = 1 + self.fastest * duration if motion.speed.size else 1
        moving = self.root_mass * motion.speed_bound()
        size = math.sqrt(2 * energy) + moving + self.drive
        self.total = math.hypot(self.total, _UNIT * steps * size)

    @property
    def load(self) -> float:
        """One rounding of the tangential load so far [N]."""
        return self.total * float(self.root_springs[0])

    @property
    def force(self) -> FloatArray:
        """One rounding of the net force on each block so far [N]."""
        return self.total * (self.root_springs[:-1] + self.root_springs[1:])

    @property
    def speed(self) -> float:
        """One rounding of a velocity so far [m/s]."""
        return self.total / self.root_mass

    def note(self, wrong: FloatArray | float, one: FloatArray | float) -> None:
        """Keep the largest deviation, in roundings."""
        wrong, one = np.atleast_1d(wrong), np.atleast_1d(one)
        self.most = max(self.most, float(np.max(wrong[one > 0] / one[one > 0], initial=0.0)))


class _Auditor:
    """The carried state (spring forces and velocities, not positions) and what was found so far."""

    def __init__(self, run: Run, tolerance: Tolerances) -> None:
        chain = self.chain = run.chain
        self.run, self.tolerance = run, tolerance
        self.springs, self.strength, self.friction = chain.springs, chain.strength, chain.kinetic_friction
        self.mode = np.zeros(chain.n_blocks, dtype=np.int64)
        self.velocity = np.array(run.start_velocities, dtype=float)
        # the force of the spring behind each block, and a zero ahead of block N
        stretch = -np.diff(np.asarray(run.start_positions, dtype=float), prepend=0.0)
        self.spring_force = np.append(self.springs * stretch, 0.0)
        # without friction: the largest spring force at the start, that of the speeds, what the drive adds
        impact = np.abs(self.velocity).max() * math.sqrt(self.springs.max() * chain.mass)
        without = np.abs(self.spring_force).max() + impact + chain.loading_rate * float(run.duration)
        self.force_scale = float(self.strength.max() or without or chain.normal_load)
        self.velocity_scale = self.force_scale / math.sqrt(self.springs.min() * chain.mass)
        self.rounding = _Rounding(run)
        self.time = 0.0
        self.velocity_violation = self.stick_violation = 0.0
        self.transition_residual = self.time_residual = self.energy_residual = 0.0
        self.work = self.heat = 0.0
        self.problems: list[str] = []
        kept = max(32, int(_MODES_KEPT // (16 * chain.n_blocks**2)))
        self.normal_modes = lru_cache(maxsize=kept)(lambda first, last: normal_modes(chain, first, last))

    def audit(self) -> Audit:
        """Walk through the run, interval by interval."""
        start_energy = self.energy()
        intervals = np.asarray(self.run.intervals, dtype=float)
        instants = np.cumsum(intervals, dtype=np.longdouble).astype(float).tolist()
        transitions = self.run.transitions[["time", "block", "mode", "tangential_load"]].tolist()
        started, n_audited = False, 0
        for duration, instant in zip(intervals.tolist(), instants, strict=True):
            final = n_audited == len(transitions)
            if not started and (duration > 0 or final):
                started = True
                self.check_start()
            if duration > 0:
                self.pass_interval(duration)
            self.time = instant
            n_audited += 1
            if len(self.problems) >= MAX_PROBLEMS:
                break
            if final:
                self.check_time(float(self.run.duration), "the duration")
                self.check_energy(start_energy)
            else:
                time, block, mode, load = transitions[n_audited - 1]
                self.apply_transition(time, block, mode, load, at_start=not started)
        return Audit(
            velocity_violation=self.velocity_violation,
            velocity_violation_relative=self.velocity_violation / self.velocity_scale,
            stick_violation=self.stick_violation,
            stick_violation_relative=self.stick_violation / self.force_scale,
            transition_residual=self.transition_residual,
            time_residual=self.time_residual,
            energy_residual=self.energy_residual,
            roundings=self.rounding.most,
            n_intervals=n_audited,
            problems=tuple(self.problems[:MAX_PROBLEMS]),
        )

    def net_force(self) -> FloatArray:
        """Force of the springs and the drive on each block [N], shape (N,) (Eqs. 2-4)."""
        return self.spring_force[:-1] - self.spring_force[1:]

    def energy(self) -> float:
        """Kinetic energy of the blocks and elastic energy of the springs [J]."""
        kinetic = 0.5 * self.chain.mass * float(self.velocity @ self.velocity)
        return kinetic + 0.5 * float(self.spring_force[:-1] ** 2 @ (1 / self.springs))

    def report(self, sentence: str, time: float | None = None) -> None:
        """Add a problem."""
        self.problems.append(f"t = {self.time if time is None else time:.12g} s: {sentence}")

    def check_start(self) -> None:
        """Stuck blocks are at rest and within their strength once the transitions at time 0 are done."""
        stuck = self.mode == 0
        for i in np.flatnonzero(stuck & (self.velocity != 0)):
            self.report(f"block {i + 1} starts with {self.velocity[i]:.6g} m/s but is stuck")
            self.velocity[i] = 0.0
        excess = np.where(stuck, np.abs(self.net_force()) - self.strength, 0.0)
        self.stick_violation = max(self.stick_violation, float(excess.max()))
        for i in np.flatnonzero(excess > self.allowed_force(self.rounding.force)):
            self.report(f"block {i + 1} starts stuck, with a force {excess[i]:.3g} N beyond mu_s w")

    def allowed_force(self, one: FloatArray) -> FloatArray:
        """What forces may be off by [N], each with its rounding."""
        if self.tolerance.roundings:
            return self.tolerance.roundings * one
        return np.full(np.shape(one), self.tolerance.force * self.force_scale)

    def allowed_speed(self) -> float:
        """What a velocity may be off by [m/s]."""
        if self.tolerance.roundings:
            return self.tolerance.roundings * self.rounding.speed
        return self.tolerance.velocity * self.velocity_scale

    def pass_interval(self, duration: float) -> None:
        """Check Coulomb's law inside an interval and move the state to its end."""
        motion = self.motion()
        gauges = _Gauges(self, motion)
        before = self.energy()
        self.advance(motion, duration)
        self.rounding.add(duration, motion, max(before, self.energy()))
        n = len(gauges.sliding)
        force = self.rounding.force[gauges.blocks[n:]]
        tolerance = np.empty(len(gauges.blocks))
        tolerance[:n] = self.allowed_speed() / self.velocity_scale
        tolerance[n:] = self.allowed_force(force) / self.force_scale
        lowest, when = gauges.lowest(duration, tolerance)
        self.rounding.note(-lowest[:n] * self.velocity_scale, np.full(n, self.rounding.speed))
        self.rounding.note(-lowest[n:] * self.force_scale, force)
        against = -self.velocity_scale * min(lowest[:n].tolist(), default=0.0)
        beyond = -self.force_scale * min(lowest[n:].tolist(), default=0.0)
        self.velocity_violation = max(self.velocity_violation, against)
        self.stick_violation = max(self.stick_violation, beyond)
        for j in np.flatnonzero(lowest < -tolerance):
            block, time = gauges.blocks[j] + 1, self.time + when[j]
            if j < n:
                mode, speed = self.mode[block - 1], -lowest[j] * self.velocity_scale
                self.report(f"block {block} slides against its mode {mode:+d} at {speed:.3g} m/s", time)
            else:
                excess = -lowest[j] * self.force_scale
                way = "forward" if j < n + len(gauges.stuck) else "backward"
                self.report(f"block {block} is stuck, pushed {way} {excess:.3g} N beyond mu_s w", time)

    def groups(self) -> list[tuple[int, int]]:
        """First and last block, from 0, of each row of neighbours that slide."""
        edges = np.diff((self.mode != 0).astype(np.int8), prepend=0, append=0)
        first, behind = np.flatnonzero(edges == 1), np.flatnonzero(edges == -1)
        return list(zip(first.tolist(), (behind - 1).tolist(), strict=True))

    def modes(self) -> _Modes:
        """Normal modes of all blocks that slide, and of all springs; each group has its own."""
        springs = self.chain.n_blocks + 1
        n = int(np.count_nonzero(self.mode))
        modes = _Modes(np.zeros(n), np.zeros((n, n)), np.zeros((springs, n)))
        done = 0
        for first, last in self.groups():
            group = self.normal_modes(first, last)
            columns = slice(done, done + len(group.frequencies))
            modes.frequencies[columns] = group.frequencies
            modes.shapes[columns, columns] = group.shapes
            modes.spring_shapes[first : first + len(group.spring_shapes), columns] = group.spring_shapes
            done = columns.stop
        return modes

    def motion(self) -> _Motion:
        """Modal motion of the blocks that slide from the carried state."""
        modes, slides = self.modes(), self.mode != 0
        force = (self.net_force() - self.mode * self.friction)[slides]
        # The drive loads block 1 only.
        loads_first = modes.shapes[0] if slides[0] else np.zeros(len(force))
        return _Motion(
            modes=modes,
            speed=self.velocity[slides] @ modes.shapes,
            push=force @ modes.shapes / self.chain.mass,
            ramp=self.chain.loading_rate / self.chain.mass * loads_first,
        )

    def advance(self, motion: _Motion, duration: float) -> None:
        """Move the state to the end of the interval and add up work and heat."""
        self.work += self.chain.drive_velocity * self.load_impulse(motion, duration)
        slides = self.mode != 0
        (displacement,), (velocity,), _ = motion.at(np.array([duration]))
        slip = motion.modes.shapes @ displacement
        self.heat += float((self.friction * self.mode)[slides] @ slip)
        self.velocity[slides] = motion.modes.shapes @ velocity
        self.spring_force[0] += self.chain.loading_rate * duration
        self.spring_force -= motion.modes.spring_shapes @ displacement

    def load_impulse(self, motion: _Motion, duration: float) -> float:
        """Integral of the tangential load over an interval [N s].

        Under a stiff drive the load swings about an equilibrium that hardly grows, while K V t and K x_1 both
        do: so it is integrated as the equilibrium and the swings. At equilibrium each spring from the drive
        to the first block that sticks has the force of the one behind it less the friction between, and
        together they are as long as they are.
        """
        if self.mode[0] == 0:
            return (float(self.spring_force[0]) + 0.5 * self.chain.loading_rate * duration) * duration
        last = self.groups()[0][1]
        friction = np.append(0.0, np.cumsum(self.mode[: last + 1] * self.friction[: last + 1]))
        force, rate = float(friction[-1]), 0.0
        if last + 1 < self.chain.n_blocks:
            softness = 1 / self.springs[: last + 2]
            force = float((self.spring_force[: last + 2] + friction) @ softness / softness.sum())
            rate = self.chain.drive_velocity / float(softness.sum())
        swings = float(motion.modes.spring_shapes[0] @ motion.swing(duration))
        return (force + 0.5 * rate * duration) * duration + swings

    def apply_transition(self, time: float, block: int, mode: int, load: float, at_start: bool) -> None:
        """Check a transition against the switching rule and the record, then change the block's mode."""
        i = block - 1
        self.check_time(time, f"a transition of block {block}")
        self.check_load(load, block)
        if mode == self.mode[i]:
            self.report(f"block {block} changes to mode {mode:+d}, which it already has")
        elif self.mode[i] == 0:
            self.check_release(block, mode, at_start)
        elif mode == 0:
            self.check_stop(block)
            self.check_force(block, "sticks with a force beyond mu_s w", self.excess(i))
        else:
            self.check_stop(block)
            self.check_force(block, "turns round without a force beyond mu_s w", -self.excess(i, mode))
        if mode != self.mode[i] and self.mode[i] != 0:
            self.velocity[i] = 0.0
        self.mode[i] = mode

    def excess(self, i: int, direction: int = 0) -> float:
        """Force on block i beyond its strength [N], in one direction (+1, -1) or in its own (0)."""
        force = float(self.spring_force[i] - self.spring_force[i + 1])
        return (force * direction if direction else abs(force)) - float(self.strength[i])

    def check_release(self, block: int, mode: int, at_start: bool) -> None:
        """A stuck block slides off at its limit; at the start it may be overloaded, or move."""
        velocity, excess = float(self.velocity[block - 1]), self.excess(block - 1, mode)
        if at_start and velocity != 0:
            if velocity * mode < 0:
                self.report(f"block {block} starts with {velocity:.6g} m/s in mode {mode:+d}")
        else:
            self.check_force(block, f"releases to {mode:+d} below the limit", -excess)
            if not at_start:
                self.check_force(block, f"releases to {mode:+d} beyond the limit", excess)

    def check_force(self, block: int, what: str, wrong: float, one: float | None = None) -> None:
        """Count a force that is wrong by some newtons, if positive; one rounding is that of the net force."""
        rounding = float(self.rounding.force[block - 1]) if one is None else one
        self.transition_residual = max(self.transition_residual, wrong / self.force_scale)
        self.rounding.note(wrong, rounding)
        if wrong > self.allowed_force(np.array(rounding)):
            self.report(f"block {block} {what}, by {wrong:.3g} N")

    def check_stop(self, block: int) -> None:
        """A block that stops sliding in its direction is at rest."""
        speed = abs(float(self.velocity[block - 1]))
        self.transition_residual = max(self.transition_residual, speed / self.velocity_scale)
        self.rounding.note(speed, self.rounding.speed)
        if speed > self.allowed_speed():
            self.report(f"block {block} changes its mode while it moves at {speed:.3g} m/s")

    def check_load(self, load: float, block: int) -> None:
        """The recorded tangential load is the force of the drive's spring."""
        wrong = abs(load - float(self.spring_force[0]))
        if math.isnan(wrong):
            self.report(f"a transition of block {block} has no tangential load")
        what = f"has {load:.9g} N recorded as tangential load, which is wrong"
        self.check_force(block, what, wrong, self.rounding.load)

    def check_time(self, time: float, what: str) -> None:
        """A recorded time is the sum of the intervals up to it."""
        wrong = abs(time - self.time)
        self.time_residual = max(self.time_residual, wrong)
        if not wrong <= self.tolerance.time * float(self.run.duration):
            self.report(f"{what} is recorded {time - self.time:.3g} s from the sum of the intervals")

    def check_energy(self, start_energy: float) -> None:
        """Work of the drive = change of kinetic and elastic energy + friction heat."""
        chain = self.chain
        # A block without friction gives back all the work once a period.
        carried = 0.5 * chain.n_blocks * chain.mass * chain.drive_velocity**2
        turnover = max(abs(self.work), abs(self.heat), start_energy, carried)
        if turnover > 0:
            self.energy_residual = abs(self.work - (self.energy() - start_energy) - self.heat) / turnover
        if self.energy_residual > self.tolerance.energy:
            self.report(f"work, energy and heat are out of balance by {self.energy_residual:.3g} (relative)")
