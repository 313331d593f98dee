"""Audit a run: check its intervals and transitions one after the other."""

import math
from functools import lru_cache, partial

import numpy as np

from precursors.audit.carried import start_of
from precursors.audit.conditions import pass_interval
from precursors.audit.motion import normal_modes, rows_and_modes
from precursors.audit.report import Audit
from precursors.model.chain import FREE, linear_weights
from precursors.model.checks import positive
from precursors.solver.record import arrays_of, find_range_error, find_shape_error
from precursors.solver.run import Run
from precursors.support.waiting import bar

TIME_TOLERANCE = 1e-12
"""Tolerance of recorded times, relative to the duration: each transition rounds them,
while the intervals are more accurate."""

THETA_TOLERANCE = 1e-12
"""Tolerance of weights, relative to F_Z."""

MAX_PROBLEMS = 20
"""The audit stops after this many problems: one wrong transition makes the rest
wrong."""

_MEMORY = 2e8  # bytes for cached normal modes

MAX_VALUES = 500_000_000
"""The audit stops after computing this many values, in about half a minute. Slides that
are long compared with the period of the fastest vibration need more."""


def audit_run(run: Run, roundings: float) -> Audit:
    """Audit a run (see `precursors.audit`)."""
    if not isinstance(run, Run):
        raise TypeError(f"audit needs a Run, but got {type(run).__name__}")
    positive("roundings", roundings, "1")
    if problem := _find_malformed(run):
        return Audit(problems=[problem])
    auditor = Auditor(run, roundings)
    auditor.walk()
    return auditor.result


def _find_malformed(run: Run) -> str:
    """Describe why the arrays of a run cannot be audited; return "" if they can."""
    arrays = arrays_of(run)
    if reason := find_shape_error(arrays) or find_range_error(arrays):
        return reason
    chain = run.chain
    if math.isnan(chain.theta):
        return ""
    of_theta = linear_weights(chain.n_blocks, chain.normal_load, chain.theta)
    if np.allclose(of_theta, chain.weights, 0, THETA_TOLERANCE * chain.normal_load):
        return ""
    return f"theta = {chain.theta:.6g} is not that of the weights"


class Auditor:
    """An audit in progress: the state that is carried through the run, and the
    result."""

    def __init__(self, run: Run, roundings: float) -> None:
        self.run = run
        self.roundings = roundings
        self.state = start_of(run)
        room = max(32, int(_MEMORY // (16 * run.chain.n_blocks**2)))
        self.modes_of_row = lru_cache(room)(partial(normal_modes, run.chain))
        self.time = 0.0
        self.values_left = MAX_VALUES
        self.result = Audit(roundings=0.0)

    def walk(self) -> None:
        """Walk through the run, interval by interval, up to `MAX_PROBLEMS` problems."""
        result = self.result
        intervals = self.run.intervals.tolist()
        instants = np.cumsum(intervals, dtype=np.longdouble).astype(float).tolist()
        transitions = [*self.run.transitions.tolist(), None]
        after = self.run.states.after
        stored = np.searchsorted(after, np.arange(len(transitions) + 1)).tolist()
        started = False
        rows = map(range, stored, stored[1:])
        steps = zip(intervals, instants, transitions, rows, strict=True)
        steps_with_bar = bar("auditing", len(intervals), steps)
        for duration, instant, transition, states in steps_with_bar:
            if not started and (duration > 0 or transition is None):
                started = True
                self.check_start()
            passed = 0.0
            for row in states:
                offset = self.run.states.offset[row]
                if not self.slide(offset - passed):
                    return
                self.check_state(row)
                passed = offset
            if not self.slide(duration - passed):
                return
            self.time = instant
            result.n_intervals += 1
            if len(result.problems) >= MAX_PROBLEMS:
                del result.problems[MAX_PROBLEMS:]
                return
            if transition:
                self.check_transition(not started, *transition)
        self.check_time(self.run.duration, "the duration")

    def slide(self, duration: float) -> bool:
        """Check Coulomb's law between transitions and advance the state.

        Return False if that takes too much work.
        """
        if duration == 0:
            return True
        state = self.state
        rows, modes = rows_and_modes(state.moves(), self.modes_of_row)
        passed = pass_interval(
            state, rows, modes, duration, self.roundings, self.values_left
        )
        self.values_left -= passed.computed
        if self.values_left < 0:
            self.result.is_undecided = not self.result.problems
            radians = duration * modes.frequencies.max(initial=0.0)
            self.report(
                f"the audit ends here: it cannot check {duration:.3g} s of "
                f"sliding, {radians:.3g} radians of the fastest mode"
            )
            return False
        for j in np.flatnonzero(np.signbit(passed.lowest)).tolist():
            what, unit = passed.describe(j, state.mode)
            when = self.time + passed.when[j]
            self.check(-passed.lowest[j], passed.rounding[j], what, unit, when)
        self.time += duration
        return True

    def check_state(self, row: int) -> None:
        """Check that a stored state is the present state."""
        state = self.state
        stored = self.run.states
        if (stored.mode[row] != state.mode).any():
            self.report(
                f"stored state {row} has modes that differ from those of the blocks"
            )
        per_speed = np.full(len(state.velocity), 1.0 / math.sqrt(state.mass))
        for what, unit, wrong, per in (
            (
                "force",
                "N",
                stored.force[row] - state.spring_force[:-1],
                np.sqrt(state.springs),
            ),
            ("velocity", "m/s", stored.velocity[row] - state.velocity, per_speed),
        ):
            i = int(np.argmax(abs(wrong) / per))
            self.check(
                abs(wrong[i]),
                state.rounding[0] * per[i],
                f"stored state {row} has a {what} of block {i + 1} that is wrong by",
                unit,
            )

    def check_transition(
        self, at_start: bool, time: float, block: int, mode: int, load: float
    ) -> None:
        """Check a recorded transition, then change the mode of the block."""
        state = self.state
        self.check_time(time, f"a transition of block {block}")
        self.check(
            abs(load - state.spring_force[0]),
            state.rounding[0] * math.sqrt(state.springs[0]),
            f"block {block} has {load:.9g} N recorded as tangential load, wrong by",
            "N",
        )
        old = state.mode[block - 1]
        if mode == old:
            self.report(
                f"block {block} changes to mode {mode:+d}, which it already has"
            )
        elif old == 0:
            self.check_release(block, mode, at_start)
        elif old == FREE:
            self.report(f"block {block} bears no load and has no transitions")
            return
        else:
            self.check_stop(block, mode)
        state.mode[block - 1] = mode

    def check_release(self, block: int, mode: int, at_start: bool) -> None:
        """Check that a stuck block is released at its limit.

        At the start it may be above its limit, or move.
        """
        state = self.state
        velocity = state.velocity[block - 1]
        excess = mode * state.net_force()[block - 1] - state.strength[block - 1]
        if at_start and velocity != 0:
            if np.sign(velocity) != mode:
                self.report(
                    f"block {block} starts with {velocity:.6g} m/s in mode {mode:+d}"
                )
        else:
            self.check_force(
                block, f"is released to {mode:+d} below the limit", -excess
            )
            if not at_start:
                self.check_force(
                    block, f"is released to {mode:+d} beyond the limit", excess
                )

    def check_stop(self, block: int, mode: int) -> None:
        """Check that a sliding block stops, and that it then sticks if friction can hold
        it."""
        state = self.state
        speed = abs(state.velocity[block - 1])
        force = state.net_force()[block - 1]
        strength = state.strength[block - 1]
        what = f"block {block} changes its mode while it moves at"
        self.check(speed, state.rounding[0] / math.sqrt(state.mass), what, "m/s")
        if mode == 0:
            what = "sticks with a force beyond mu_s w"
            self.check_force(block, what, abs(force) - strength)
        else:
            what = "turns round without a force beyond mu_s w"
            self.check_force(block, what, strength - mode * force)
        state.velocity[block - 1] = 0.0

    def check_start(self) -> None:
        """Check that stuck blocks are at rest and within their strength after the
        transitions at time 0."""
        state = self.state
        excess = np.abs(state.net_force()) - state.strength
        for i in np.flatnonzero(state.mode == 0).tolist():
            velocity = state.velocity[i]
            if velocity != 0:
                self.report(
                    f"block {i + 1} starts with {velocity:.6g} m/s but is stuck"
                )
                state.velocity[i] = 0.0
            self.check_force(i + 1, "starts stuck beyond mu_s w", excess[i])

    def check_force(self, block: int, what: str, wrong: float) -> None:
        """Check that a net force is wrong by no more than its rounding error."""
        rounding = self.state.rounding[0] * self.state.per_force[block - 1]
        self.check(wrong, rounding, f"block {block} {what}, by", "N")

    def check_time(self, time: float, what: str) -> None:
        """Check that a recorded time is the sum of the intervals before it."""
        wrong = abs(time - self.time)
        if not wrong <= TIME_TOLERANCE * self.run.duration:
            self.report(
                f"{what} is recorded {time - self.time:.3g} s from the sum of the intervals"
            )

    def check(
        self,
        wrong: float,
        rounding: float,
        what: str,
        unit: str,
        time: float | None = None,
    ) -> None:
        """Report a deviation of more than `roundings` times `rounding`.

        A negative deviation passes.
        """
        off = float(wrong) / float(rounding) if rounding > 0 else 0.0
        self.result.roundings = max(self.result.roundings, off)
        if not wrong <= self.roundings * rounding:
            self.report(f"{what} {wrong:.3g} {unit}", time)

    def report(self, sentence: str, time: float | None = None) -> None:
        """Add a problem to the result."""
        when = self.time if time is None else time
        self.result.problems.append(f"t = {when:.12g} s: {sentence}")
