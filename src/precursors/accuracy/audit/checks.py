"""The walk through the intervals and transitions of a run, which notes what is no motion of the model."""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np

from precursors.accuracy.audit.conditions import Conditions
from precursors.accuracy.audit.motion import Motion, modes_of_all, normal_modes
from precursors.model.chain import FloatArray
from precursors.solver.run import Run
from precursors.support.waiting import tell

ROUNDINGS = 16.0
"""What may be off, in roundings of a step (see `Auditor`): so many are the 8 eps that the solver counts as
zero. Deviations come to 2 in the paper's runs, and to 12 in 20,000 random chains."""

TIME_TOLERANCE = 1e-12
"""Of the duration: recorded times are rounded once a transition, the intervals are not."""

MAX_PROBLEMS = 20
"""The audit stops at this many: what follows a wrong transition is wrong, and says nothing new."""

_UNIT = 2.0**-53  # a rounding, relative
_START_ROUNDINGS = 8
_BYTES_OF_MODES = 2e8


class Auditor:
    """The carried state (spring forces and velocities, not positions) and what was found so far.

    Solver and auditor carry spring forces f and velocities v in doubles. Each step rounds them by some units
    of 2^-53 of the largest they can be, in the norm sum f_i^2/k_i + m v_i^2, twice the energy. A step is a
    transition or a radian of the fastest motion, and the drive counts as a mass that moves. In this norm the
    difference of two motions with the same transitions does not grow: springs and masses keep it, and what
    stops loses it. So roundings add up: those of an interval one by one, as they may all go the same way,
    those of different intervals as squares. One rounding a step comes to `one` [sqrt(J)], which is
    one/sqrt(m) of a velocity and one sqrt(k) of the force of a spring.
    """

    def __init__(self, run: Run, roundings: float) -> None:
        chain = self.chain = run.chain
        self.run, self.roundings = run, roundings
        self.springs, self.strength, self.friction = chain.springs, chain.strength, chain.kinetic_friction
        self.mode = np.zeros(chain.n_blocks, dtype=np.int64)
        self.velocity = np.array(run.start_velocities, dtype=float)
        # the force of the spring behind each block, and a zero ahead of block N
        positions = np.asarray(run.start_positions, dtype=float)
        self.spring_force = np.append(self.springs * -np.diff(positions, prepend=0.0), 0.0)
        self.time = self.work = self.heat = self.turnover = self.energy_rounding = 0.0
        self.most, self.energy_residual, self.n_audited = 0.0, math.nan, 0
        self.problems: list[str] = []
        # Forces at the start are differences of positions, which are known to their rounding.
        ends = positions**2 + np.append(0.0, positions[:-1]) ** 2
        self.drive_momentum = math.sqrt(chain.mass) * chain.drive_velocity
        self.one = _UNIT * (_START_ROUNDINGS * math.sqrt(float(self.springs @ ends)) + self.drive_momentum)
        self.fastest = 2 * math.sqrt(self.springs.max() / chain.mass)
        roots = np.sqrt(np.append(self.springs, 0.0))
        self.per_load, self.per_force = float(roots[0]), roots[:-1] + roots[1:]
        self.per_speed = 1 / math.sqrt(chain.mass)
        kept = max(32, int(_BYTES_OF_MODES // (16 * chain.n_blocks**2)))
        self.modes_of_row = lru_cache(maxsize=kept)(lambda first, last: normal_modes(chain, first, last))

    def walk(self) -> None:
        """Walk through the run, interval by interval, up to `MAX_PROBLEMS` problems."""
        start_energy = self.energy()
        intervals = np.asarray(self.run.intervals, dtype=float)
        instants = np.cumsum(intervals, dtype=np.longdouble).astype(float).tolist()
        transitions = self.run.transitions[["time", "block", "mode", "tangential_load"]].tolist()
        started = False
        steps = zip(intervals.tolist(), instants, [*transitions, None], strict=True)
        for duration, instant, transition in tell("auditing", steps, lambda: self.time / self.run.duration):
            if not started and (duration > 0 or transition is None):
                started = True
                self.check_start()
            if duration > 0:
                self.pass_interval(duration)
            self.time = instant
            self.n_audited += 1
            if len(self.problems) >= MAX_PROBLEMS:
                del self.problems[MAX_PROBLEMS:]
                return
            if transition:
                time, block, mode, load = transition
                self.check_time(time, f"a transition of block {block}")
                self.check_load(load, block)
                self.apply_transition(block, mode, at_start=not started)
        self.check_time(float(self.run.duration), "the duration")
        self.check_energy(start_energy)

    def net_force(self) -> FloatArray:
        """Force of the springs and the drive on each block [N], shape (N,) (Eqs. 2-4)."""
        return self.spring_force[:-1] - self.spring_force[1:]

    def energy(self) -> float:
        """Kinetic energy of the blocks and elastic energy of the springs [J]."""
        kinetic = 0.5 * self.chain.mass * float(self.velocity @ self.velocity)
        return kinetic + 0.5 * float(self.spring_force[:-1] ** 2 @ (1 / self.springs))

    def add_rounding(self, steps: float, motion: Motion, energy: float) -> None:
        """Add one rounding for each step of an interval in which the energy is at most this [J]."""
        size = math.sqrt(2 * energy) + math.sqrt(self.chain.mass) * motion.largest_speed()
        self.one = math.hypot(self.one, _UNIT * steps * (size + self.drive_momentum))

    def within(self, wrong: float, one: float) -> bool:
        """Note a deviation, if positive; return whether it is within so many roundings of size `one`."""
        self.most = max(self.most, wrong / one if one > 0 else 0.0)
        return wrong <= self.roundings * one

    def report(self, sentence: str, time: float | None = None) -> None:
        """Add a problem."""
        self.problems.append(f"t = {self.time if time is None else time:.12g} s: {sentence}")

    def check_start(self) -> None:
        """Stuck blocks are at rest and within their strength once the transitions at time 0 are done."""
        for i in np.flatnonzero((self.mode == 0) & (self.velocity != 0)):
            self.report(f"block {i + 1} starts with {self.velocity[i]:.6g} m/s but is stuck")
            self.velocity[i] = 0.0
        excess = np.abs(self.net_force()) - self.strength
        for i in np.flatnonzero((self.mode == 0) & (excess > 0)):
            if not self.within(float(excess[i]), self.one * self.per_force[i]):
                self.report(f"block {i + 1} starts stuck, with a force {excess[i]:.3g} N beyond mu_s w")

    def pass_interval(self, duration: float) -> None:
        """Check Coulomb's law inside an interval and move the state to its end."""
        motion = self.motion()
        loading_rate = self.chain.loading_rate
        conditions = Conditions(motion, self.mode, self.net_force(), self.strength, loading_rate)
        before = self.energy()
        terms = self.advance(motion, duration)
        energy = max(before, self.energy())
        steps = 1 + self.fastest * duration if motion.speed.size else 1
        self.add_rounding(steps, motion, energy)
        self.turnover = max(self.turnover, energy) + terms
        self.energy_rounding += _UNIT * steps * (energy + terms)
        n, stuck = len(conditions.sliding), conditions.stuck
        blocks = np.concatenate([conditions.sliding, stuck, stuck])
        one = self.one * np.append(np.full(n, self.per_speed), self.per_force[blocks[n:]])
        lowest, when = conditions.lowest(duration, self.roundings * one)
        for j in np.flatnonzero(lowest < 0):
            wrong, block = float(-lowest[j]), blocks[j] + 1
            if self.within(wrong, float(one[j])):
                continue
            if j < n:
                what = f"slides against its mode {self.mode[block - 1]:+d} at {wrong:.3g} m/s"
            else:
                way = "forward" if j < n + len(stuck) else "backward"
                what = f"is stuck, pushed {way} {wrong:.3g} N beyond mu_s w"
            self.report(f"block {block} {what}", self.time + when[j])

    def motion(self) -> Motion:
        """Motion of the blocks that slide from the carried state."""
        modes, slides = modes_of_all(self.mode, self.modes_of_row), self.mode != 0
        force = (self.net_force() - self.mode * self.friction)[slides]
        # The drive loads block 1 only.
        loads_first = modes.shapes[0] if slides[0] else np.zeros(len(force))
        return Motion(
            modes=modes,
            speed=self.velocity[slides] @ modes.shapes,
            push=force @ modes.shapes / self.chain.mass,
            ramp=self.chain.loading_rate / self.chain.mass * loads_first,
        )

    def advance(self, motion: Motion, duration: float) -> float:
        """Move the state to the end of the interval, add up work and heat; return the sum of their terms."""
        slides, loading_rate = self.mode != 0, self.chain.loading_rate
        impulses = (
            self.spring_force[0] * duration,
            0.5 * loading_rate * duration**2,
            -float(motion.modes.spring_shapes[0] @ motion.integral(duration)),
        )
        (displacement,), (velocity,), _ = motion.at(np.array([duration]))
        heat = (self.friction * self.mode)[slides] * (motion.modes.shapes @ displacement)
        self.work += self.chain.drive_velocity * sum(impulses)
        self.heat += float(heat.sum())
        self.velocity[slides] = motion.modes.shapes @ velocity
        self.spring_force[0] += loading_rate * duration
        self.spring_force -= motion.modes.spring_shapes @ displacement
        return self.chain.drive_velocity * sum(map(abs, impulses)) + float(abs(heat).sum())

    def apply_transition(self, block: int, mode: int, at_start: bool) -> None:
        """Check a transition against the switching rule, then change the block's mode."""
        i, old = block - 1, int(self.mode[block - 1])
        force, strength = float(self.net_force()[i]), float(self.strength[i])
        if mode == old:
            self.report(f"block {block} changes to mode {mode:+d}, which it already has")
        elif old == 0:
            self.check_release(block, mode, force * mode - strength, at_start)
        else:
            self.check_stop(block)
            if mode == 0:
                self.check_force(block, "sticks with a force beyond mu_s w", abs(force) - strength)
            else:
                self.check_force(block, "turns round without a force beyond mu_s w", strength - force * mode)
            self.velocity[i] = 0.0
        self.mode[i] = mode

    def check_release(self, block: int, mode: int, excess: float, at_start: bool) -> None:
        """A stuck block slides off at its limit; at the start it may be overloaded, or move."""
        velocity = float(self.velocity[block - 1])
        if at_start and velocity != 0:
            if velocity * mode < 0:
                self.report(f"block {block} starts with {velocity:.6g} m/s in mode {mode:+d}")
        else:
            self.check_force(block, f"releases to {mode:+d} below the limit", -excess)
            if not at_start:
                self.check_force(block, f"releases to {mode:+d} beyond the limit", excess)

    def check_force(self, block: int, what: str, wrong: float) -> None:
        """A net force is not wrong by more than its rounding."""
        if not self.within(wrong, self.one * self.per_force[block - 1]):
            self.report(f"block {block} {what}, by {wrong:.3g} N")

    def check_stop(self, block: int) -> None:
        """A block that stops sliding in its direction is at rest."""
        speed = abs(float(self.velocity[block - 1]))
        if not self.within(speed, self.one * self.per_speed):
            self.report(f"block {block} changes its mode while it moves at {speed:.3g} m/s")

    def check_load(self, load: float, block: int) -> None:
        """The recorded tangential load is the force of the drive's spring."""
        wrong = abs(load - float(self.spring_force[0]))
        if not self.within(wrong, self.one * self.per_load):
            self.report(f"block {block} has {load:.9g} N recorded as tangential load, wrong by {wrong:.3g} N")

    def check_time(self, time: float, what: str) -> None:
        """A recorded time is the sum of the intervals up to it."""
        wrong = abs(time - self.time)
        if not wrong <= TIME_TOLERANCE * float(self.run.duration):
            self.report(f"{what} is recorded {time - self.time:.3g} s from the sum of the intervals")

    def check_energy(self, start_energy: float) -> None:
        """Work of the drive = change of kinetic and elastic energy + friction heat."""
        wrong = abs(self.work - (self.energy() - start_energy) - self.heat)
        self.energy_residual = wrong / self.turnover if self.turnover > 0 else 0.0
        if not self.within(wrong, self.energy_rounding):
            self.report(f"work, energy and heat are out of balance by {self.energy_residual:.3g} (relative)")
