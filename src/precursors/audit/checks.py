"""The walk through the intervals and transitions of a run, which notes what is no
motion of the model."""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np

from precursors.audit.conditions import Conditions
from precursors.audit.motion import Motion, modes_of_all, normal_modes
from precursors.model.chain import FloatArray
from precursors.solver.run import Run
from precursors.support.waiting import tell

TIME_TOLERANCE = 1e-12
"""Of the duration: recorded times are rounded once a transition, the intervals are
not."""

MAX_PROBLEMS = 20
"""The audit stops at this many: what follows a wrong transition is wrong, and says
nothing new."""

_UNIT = 2.0**-53  # a rounding, relative
_START_ROUNDINGS = 8


class Auditor:
    """The carried state (spring forces and velocities, not positions) and what was
    found so far.

    Solver and auditor carry spring forces f and velocities v in doubles. Each step
    rounds them by some units of 2^-53 of the largest they can be, in the norm sum
    f_i^2/k_i + m v_i^2, twice the energy. A step is a transition or a radian of the
    fastest motion, and the drive counts as a mass that moves. In this norm the
    difference of two motions with the same transitions does not grow: springs and
    masses keep it, and what stops loses it. So roundings add up: those of an interval
    one by one, as they may all go the same way, those of different intervals as
    squares. One rounding a step comes to `one` [sqrt(J)], which is one/sqrt(m) of a
    velocity and one sqrt(k) of the force of a spring.
    """

    def __init__(self, run: Run, roundings: float) -> None:
        chain = self.chain = run.chain
        self.run = run
        self.roundings = roundings
        self.springs = chain.springs
        self.strength = chain.strength
        self.friction = chain.kinetic_friction
        self.mode = np.zeros(chain.n_blocks, dtype=np.int64)
        self.velocity = np.array(run.start_velocities, dtype=float)
        # the force of the spring behind each block, and a zero ahead of block N
        positions = np.asarray(run.start_positions, dtype=float)
        self.spring_force = np.append(
            self.springs * -np.diff(positions, prepend=0.0), 0.0
        )
        self.time = self.work = self.heat = self.turnover = self.energy_rounding = 0.0
        self.most = 0.0
        self.energy_residual = math.nan
        self.n_audited = 0
        self.problems: list[str] = []
        # Forces at the start are differences of positions, which are known to their
        # rounding.
        ends = positions**2 + np.append(0.0, positions[:-1]) ** 2
        self.drive_momentum = math.sqrt(chain.mass) * chain.drive_velocity
        at_start = _START_ROUNDINGS * math.sqrt(float(self.springs @ ends))
        self.one = _UNIT * math.hypot(at_start, self.drive_momentum)
        self.fastest = 2 * math.sqrt(self.springs.max() / chain.mass)
        self.per_force = np.sqrt(self.springs)
        self.per_load = float(self.per_force[0])
        self.per_force[:-1] += np.sqrt(self.springs[1:])
        self.per_speed = 1 / math.sqrt(chain.mass)
        # Within 200 MB.
        keep = lru_cache(maxsize=max(32, int(2e8 // (16 * chain.n_blocks**2))))
        self.modes_of_row = keep(lambda first, last: normal_modes(chain, first, last))

    def walk(self) -> None:
        """Walk through the run, interval by interval, up to `MAX_PROBLEMS` problems."""
        start_energy = self.energy()
        intervals = np.asarray(self.run.intervals, dtype=float)
        instants = np.cumsum(intervals, dtype=np.longdouble).astype(float).tolist()
        transitions = self.run.transitions[
            ["time", "block", "mode", "tangential_load"]
        ].tolist()
        started = False
        steps = zip(intervals.tolist(), instants, [*transitions, None], strict=True)
        for duration, instant, transition in tell(
            "auditing", steps, lambda: self.time / self.run.duration
        ):
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
                what = f"block {block} has {load:.9g} N recorded as tangential load, wrong by"
                self.check(
                    abs(load - float(self.spring_force[0])),
                    self.one * self.per_load,
                    what,
                    "N",
                )
                self.apply_transition(block, mode, at_start=not started)
        self.check_time(float(self.run.duration), "the duration")
        self.check_energy(start_energy)

    def net_force(self) -> FloatArray:
        """Force of the springs and the drive on each block [N], shape (N,) (Eqs.
        2-4)."""
        return self.spring_force[:-1] - self.spring_force[1:]

    def energy(self) -> float:
        """Kinetic energy of the blocks and elastic energy of the springs [J]."""
        kinetic = 0.5 * self.chain.mass * float(self.velocity @ self.velocity)
        return kinetic + 0.5 * float(self.spring_force[:-1] ** 2 @ (1 / self.springs))

    def check(
        self, wrong: float, one: float, what: str, unit: str, time: float | None = None
    ) -> None:
        """Report a deviation of more than so many roundings of size `one`; one that is
        negative is none."""
        self.most = max(self.most, wrong / one if one > 0 else 0.0)
        if not wrong <= self.roundings * one:
            self.report(f"{what} {wrong:.3g} {unit}", time)

    def report(self, sentence: str, time: float | None = None) -> None:
        """Add a problem."""
        self.problems.append(
            f"t = {self.time if time is None else time:.12g} s: {sentence}"
        )

    def check_start(self) -> None:
        """Stuck blocks are at rest and within their strength once the transitions at
        time 0 are done."""
        for i in np.flatnonzero((self.mode == 0) & (self.velocity != 0)):
            self.report(
                f"block {i + 1} starts with {self.velocity[i]:.6g} m/s but is stuck"
            )
            self.velocity[i] = 0.0
        excess = np.abs(self.net_force()) - self.strength
        for block in (np.flatnonzero((self.mode == 0) & (excess > 0)) + 1).tolist():
            self.check_force(
                block, "starts stuck beyond mu_s w", float(excess[block - 1])
            )

    def pass_interval(self, duration: float) -> None:
        """Check Coulomb's law inside an interval and move the state to its end."""
        motion = self.motion()
        loading_rate = self.chain.loading_rate
        conditions = Conditions(
            motion, self.mode, self.net_force(), self.strength, loading_rate
        )
        before = self.energy()
        terms = self.advance(motion, duration)
        energy = max(before, self.energy())
        steps = 1 + self.fastest * duration if motion.speed.size else 1
        size = (
            math.sqrt(2 * energy) + math.sqrt(self.chain.mass) * motion.largest_speed()
        )
        self.one = math.hypot(self.one, _UNIT * steps * (size + self.drive_momentum))
        self.turnover = max(self.turnover, energy) + terms
        self.energy_rounding += _UNIT * steps * (energy + terms)
        n = len(conditions.sliding)
        stuck = conditions.stuck
        blocks = np.concatenate([conditions.sliding, stuck, stuck])
        one = self.one * np.append(
            np.full(n, self.per_speed), self.per_force[blocks[n:]]
        )
        lowest, when = conditions.lowest(duration, self.roundings * one)
        for j in np.flatnonzero(np.signbit(lowest)):
            block = blocks[j] + 1
            if j < n:
                what = f"slides against its mode {self.mode[block - 1]:+d} at"
                unit = "m/s"
            else:
                way = "forward" if j < n + len(stuck) else "backward"
                what = f"is stuck, pushed {way} beyond mu_s w by"
                unit = "N"
            self.check(
                float(-lowest[j]),
                float(one[j]),
                f"block {block} {what}",
                unit,
                self.time + when[j],
            )

    def motion(self) -> Motion:
        """Motion of the blocks that slide from the carried state."""
        modes = modes_of_all(self.mode, self.modes_of_row)
        slides = self.mode != 0
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
        """Move the state to the end of the interval, add up work and heat; return the
        sum of their terms."""
        slides = self.mode != 0
        loading_rate = self.chain.loading_rate
        impulses = (
            self.spring_force[0] * duration,
            0.5 * loading_rate * duration**2,
            -float(motion.modes.spring_shapes[0] @ motion.integral(duration)),
        )
        (displacement,), (velocity,), _ = motion.at(np.array([duration]))
        heat = (self.mode * self.friction)[slides] * (
            motion.modes.shapes @ displacement
        )
        self.work += self.chain.drive_velocity * sum(impulses)
        self.heat += float(heat.sum())
        self.velocity[slides] = motion.modes.shapes @ velocity
        self.spring_force[0] += loading_rate * duration
        self.spring_force -= motion.modes.spring_shapes @ displacement
        terms = np.append(heat, self.chain.drive_velocity * np.array(impulses))
        return float(abs(terms).sum())

    def apply_transition(self, block: int, mode: int, at_start: bool) -> None:
        """Check a transition against the switching rule, then change the block's
        mode."""
        i = block - 1
        old = int(self.mode[block - 1])
        force = float(self.net_force()[i])
        strength = float(self.strength[i])
        along = force if mode > 0 else -force
        if mode == old:
            self.report(
                f"block {block} changes to mode {mode:+d}, which it already has"
            )
        elif old == 0:
            self.check_release(block, mode, along - strength, at_start)
        else:
            speed = abs(float(self.velocity[i]))
            what = f"block {block} changes its mode while it moves at"
            self.check(speed, self.one * self.per_speed, what, "m/s")
            if mode == 0:
                self.check_force(
                    block, "sticks with a force beyond mu_s w", abs(force) - strength
                )
            else:
                self.check_force(
                    block, "turns round without a force beyond mu_s w", strength - along
                )
            self.velocity[i] = 0.0
        self.mode[i] = mode

    def check_release(
        self, block: int, mode: int, excess: float, at_start: bool
    ) -> None:
        """A stuck block slides off at its limit; at the start it may be overloaded, or
        move."""
        velocity = float(self.velocity[block - 1])
        if at_start and velocity != 0:
            if np.sign(velocity) != mode:
                self.report(
                    f"block {block} starts with {velocity:.6g} m/s in mode {mode:+d}"
                )
        else:
            self.check_force(block, f"releases to {mode:+d} below the limit", -excess)
            if not at_start:
                self.check_force(
                    block, f"releases to {mode:+d} beyond the limit", excess
                )

    def check_force(self, block: int, what: str, wrong: float) -> None:
        """A net force is not wrong by more than its rounding."""
        self.check(
            wrong,
            self.one * self.per_force[block - 1],
            f"block {block} {what}, by",
            "N",
        )

    def check_time(self, time: float, what: str) -> None:
        """A recorded time is the sum of the intervals up to it."""
        wrong = abs(time - self.time)
        if not wrong <= TIME_TOLERANCE * float(self.run.duration):
            self.report(
                f"{what} is recorded {time - self.time:.3g} s from the sum of the intervals"
            )

    def check_energy(self, start_energy: float) -> None:
        """Work of the drive = change of kinetic and elastic energy + friction heat."""
        wrong = abs(self.work - (self.energy() - start_energy) - self.heat)
        self.energy_residual = wrong / self.turnover if self.turnover > 0 else 0.0
        self.check(
            wrong,
            self.energy_rounding,
            "work, energy and heat are out of balance by",
            "J",
        )
