"""What methods that locate transitions as events share: the motion, its event functions and the switching.

The solvers of others meet numbers near one: force in N, time in tau = sqrt(m / stiffest spring), velocity in
N/tau. The state is y = (T_1..T_N, v_1..v_N), the force in the spring behind each block and its velocity:

    dT_i/dt = c_i (v_{i-1} - v_i),    dv_i/dt = s_i (T_i - T_{i+1}) - mode_i mu_k w_i,

with s_i = 1 where block i slides, v_0 = V, T_{N+1} = 0. These are Eqs. 2-6 as in `fixed_step`, without its
columns for the drive and the free end, which would count in a solver's error norm. A solver's relative
tolerance means the same at 0 s and at 10 s. Each slip event has its own time, counted from its onset.

An event function falls through zero at a transition. Function 2 i (i from 0) is the velocity of block i
in the direction of its mode while it slides, and its margin mu_s w_i - F_i against being released forward
while it sticks; function 2 i + 1 is its margin against being released backward."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from precursors.methods.columns import COMPILED, mode_at_rest
from precursors.methods.common import Result
from precursors.model.chain import Chain, FloatArray
from precursors.model.checks import checked_span
from precursors.solver.kernel.compiled import entry
from precursors.solver.run import Run
from precursors.solver.simulate import TransitionLimitError

# Rows of `Motion.settings`: s_i, mode_i mu_k w_i, mode_i, 1 - s_i.
SLIDES, FRICTION, MODE, STICKS = range(4)
# A block that starts gets this velocity [N/tau] in the direction of its acceleration. From exactly zero, a
# solver that brackets the stop within its first step takes the start for the root: SciPy's brentq returns it
# and the block never gets away; heyoka's finds it, drops it for its direction and misses the stop.
NUDGE = 1e-100
# More transitions than this, or more of them per block at one instant, are a solver that has lost its way.
MAX_TRANSITIONS = 1_000_000
MAX_AT_ONCE = 8

compiled = entry(Path(__file__).parent, COMPILED, error_model="numpy")


class Motion:
    """A chain in motion: its state, what each block does, and the transitions so far.

    Parameters
    ----------
    chain : Chain
        The chain, at rest with springs at natural length.
    duration : float
        Time to run [s].
    until : {None, "global slip"}
        Stop at the end of the first event in which all blocks slide at the same instant.
    state : array, shape (2 N,), optional
        Where a solver keeps the state y, if it wants to.
    settings : array, shape (4, N), optional
        Where it keeps the rows SLIDES, FRICTION, MODE, STICKS.
    nudge : float
        Velocity of a block that starts, see `NUDGE`.
    """

    def __init__(
        self,
        chain: Chain,
        duration: float,
        until: str | None,
        state: FloatArray | None = None,
        settings: FloatArray | None = None,
        nudge: float = NUDGE,
    ) -> None:
        n = chain.n_blocks
        self.chain, self.until, self.nudge = chain, until, nudge
        self.duration = checked_span(duration, until)
        self.tau, self.drive_velocity, self.coupling = scaled(chain)
        self.strength, self.friction = chain.strength, chain.kinetic_friction
        self.state = np.zeros(2 * n) if state is None else state
        self.settings = np.zeros((4, n)) if settings is None else settings
        self.state[:] = 0.0
        self.settings[:] = [[0.0], [0.0], [0.0], [1.0]]
        self.onset = 0.0  # of the present or last slip event [s]
        self.elapsed = 0.0  # since then, at the last transition [tau]
        self.n_sliding = 0
        self.was_global = False
        self.evaluations = 0
        self._at_once = 0
        self._rows: list[tuple[float, int, int, float, float]] = []
        self._waited = 0.0  # since the last transition [s]

    def next_event(self) -> bool:
        """While all blocks stick, wait in closed form until block 1 slides; False if the run ends before."""
        if self.was_global and self.until:
            self.duration = self.onset
            return False
        force, strength = self.state, float(self.strength[0])
        ahead = float(force[1]) if self.chain.n_blocks > 1 else 0.0
        wait = max((strength - (float(force[0]) - ahead)) / self.chain.loading_rate, 0.0)
        if self.onset + wait >= self.duration:
            self._waited += self.duration - self.onset
            return False
        self.onset += wait
        self._waited += wait
        self.elapsed = 0.0
        force[0] = ahead + strength
        self.switch(0, 0.0)
        return True

    @property
    def remaining(self) -> float:
        """Time from the onset of the present event to the end of the run [tau]."""
        return (self.duration - self.onset) / self.tau

    def rates(self, _time: float, state: FloatArray) -> FloatArray:
        """Right-hand side of the equations of motion in a state y."""
        result = np.empty_like(state)
        rates(state, self.settings, self.coupling, self.drive_velocity, result)
        return result

    def event_functions(self, state: FloatArray) -> FloatArray:
        """All event functions in a state y; what cannot happen is 1."""
        result = np.empty_like(state)
        event_functions(state, self.settings, self.strength, result)
        return result

    def switch(self, event: int, elapsed: float) -> bool:
        """Make the transition of an event function that has reached zero, and any that is overdue with it.

        Returns whether a block still slides; if none does, the slip event has ended.
        """
        while event >= 0:
            block, old, new, event = settle(
                self.state, self.settings, self.strength, self.friction, self.nudge, event
            )
            if new != old:
                self._record(block + 1, new, elapsed)
                self.n_sliding += abs(new) - abs(old)
                if self.n_sliding == self.chain.n_blocks:
                    self.was_global = True
        if self.n_sliding == 0:
            self.onset += elapsed * self.tau
        return self.n_sliding > 0

    def _record(self, block: int, mode: int, elapsed: float) -> None:
        interval = self._waited + (elapsed - self.elapsed) * self.tau
        self._at_once = self._at_once + 1 if interval == 0.0 else 0
        self._rows.append((self.onset + elapsed * self.tau, block, mode, float(self.state[0]), interval))
        self.elapsed, self._waited = elapsed, 0.0
        if self._at_once > MAX_AT_ONCE * self.chain.n_blocks or len(self._rows) >= MAX_TRANSITIONS:
            self.duration = self._rows[-1][0]
            raise TransitionLimitError(
                f"the solver makes transition after transition at t = {self.duration:.9g} s", self.run().run
            )

    def run(self) -> Result:
        """Transitions and cost so far."""
        time, block, mode, load, interval = zip(*self._rows, strict=True) if self._rows else ((),) * 5
        since = self._waited
        if self.n_sliding:
            since += (self.remaining - self.elapsed) * self.tau
        intervals = np.append(interval, since)
        run = Run.from_transitions(self.chain, self.duration, time, block, mode, load, intervals)
        return Result(run, self.evaluations)


def march_events(motion: Motion, slip: Callable[[Motion], Any]) -> Result:
    """Run a chain: all-stuck phases in closed form, slip events by `slip(motion)`.

    `slip` integrates from the state in `motion` and calls `motion.switch` at each event until that returns
    False or `motion.remaining` is over.
    """
    while motion.next_event():
        slip(motion)
        if motion.n_sliding:
            break
    return motion.run()


def march_restarting(motion: Motion, next_transition: Callable[[float], tuple[float, int]]) -> Result:
    """Run a chain by a solver that is started anew at each transition.

    `next_transition(time)` integrates the state in `motion` from a time [tau] to the next root of an event
    function. It returns the time of that and the function's number, or the end of the run and -1. If another
    has fired at the same instant, it is overdue after this one or fires again at once.
    """

    def slip(motion: Motion) -> None:
        time = 0.0
        while motion.n_sliding and time < motion.remaining:
            time, event = next_transition(time)
            if event >= 0:
                motion.switch(event, time)

    return march_events(motion, slip)


def time_unit(chain: Chain) -> float:
    """tau [s]."""
    return math.sqrt(chain.mass / float(np.max(chain.springs)))


def scaled(chain: Chain) -> tuple[float, float, FloatArray]:
    """tau [s], the drive's velocity [N/tau] and the springs c_i (the stiffest is 1)."""
    tau = time_unit(chain)
    return tau, chain.drive_velocity * chain.mass / tau, chain.springs / np.max(chain.springs)


@compiled
def rates(state, settings, coupling, drive_velocity, result):
    """Right-hand side of the equations of motion (Eqs. 2-6)."""
    n = coupling.shape[0]
    behind = drive_velocity
    for i in range(n):
        velocity = state[n + i]
        ahead = state[i + 1] if i + 1 < n else 0.0
        result[i] = coupling[i] * (behind - velocity)
        result[n + i] = settings[SLIDES, i] * (state[i] - ahead) - settings[FRICTION, i]
        behind = velocity


def jacobian(settings: FloatArray, coupling: FloatArray, result: FloatArray) -> FloatArray:
    """Matrix of the equations of motion, shape (2 N, 2 N), filled into zeros."""
    n = len(coupling)
    i = np.arange(n)
    result[i, n + i] = -coupling
    result[i[1:], n + i[:-1]] = coupling[1:]
    result[n + i, i] = settings[SLIDES]
    result[n + i[:-1], i[1:]] = -settings[SLIDES, :-1]
    return result


@compiled
def event_functions(state, settings, strength, result):
    """All event functions, shape (2 N,); what cannot happen is 1."""
    n = strength.shape[0]
    for i in range(n):
        if settings[MODE, i] != 0.0:
            result[2 * i] = settings[MODE, i] * state[n + i]
            result[2 * i + 1] = 1.0
        else:
            net = state[i] - (state[i + 1] if i + 1 < n else 0.0)
            result[2 * i] = strength[i] - net
            result[2 * i + 1] = strength[i] + net


@compiled
def settle(state, settings, strength, friction, nudge, event):
    """Make one transition: (block from 0, old mode, new mode, next event function that is below zero or -1).

    A stuck block is released in the direction of its force. A block that stops sticks within mu_s w, or
    slides on in the direction of the force (Eq. 5).
    """
    n = strength.shape[0]
    block = event // 2
    net = state[block] - (state[block + 1] if block + 1 < n else 0.0)
    old = int(settings[MODE, block])
    new = 1 - 2 * (event % 2) if old == 0 else mode_at_rest(net, strength[block], strength[block])
    settings[SLIDES, block] = abs(new)
    settings[FRICTION, block] = new * friction[block]
    settings[MODE, block] = new
    settings[STICKS, block] = 1 - abs(new)
    state[n + block] = new * nudge
    overdue = -1
    for i in range(n):
        if settings[MODE, i] != 0.0:
            if settings[MODE, i] * state[n + i] < 0.0:
                overdue = 2 * i
        else:
            net = state[i] - (state[i + 1] if i + 1 < n else 0.0)
            if abs(net) > strength[i]:
                overdue = 2 * i + (net < 0.0)
    return block, old, new, overdue
