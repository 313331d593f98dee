"""State, equations, event functions and transitions for third-party solvers.

Such a solver gets y = (T_1..T_N, v_1..v_N) in N and N/tau, without the columns of the
drive and of the free end, which would count in its error norm. Time is counted in tau
from the onset of each slip event, so that a relative tolerance means the same at 0 s and
at 10 s.

An event function falls through zero at a transition. Function 2 i (i from 0) is the
velocity of block i + 1 in the direction of its mode while it slides, and its margin
mu_s w - F against slipping forward while it sticks. Function 2 i + 1 is its margin
against slipping backward.
"""

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from maegawa2010.methods.columns import (
    FORCE,
    MOBILITY,
    MODE,
    SPRING,
    STRENGTH,
    VELOCITY,
    set_modes,
    time_unit,
)
from maegawa2010.methods.common import Result
from maegawa2010.methods.compiled import inner, outer
from maegawa2010.methods.equations import by_mode, net_force, rates
from maegawa2010.methods.fixed_step import (
    FINISHED,
    LOST,
    MOVING,
    PAUSED,
    SteppedMotion,
    begin_leg,
    motion_from_rest,
    obstacle,
    switch,
)
from maegawa2010.methods.march import run_of, with_room
from precursors.model.chain import Chain, FloatArray
from precursors.solver.simulate import TransitionLimitError

# A block that starts gets this velocity [N/tau] in the direction of its acceleration. If
# it were zero and the block stopped within the first step, a solver would take the start
# for the root: with SciPy the block would never move, and heyoka would miss the stop.
NUDGE = math.sqrt(np.finfo(float).tiny)
# A run with more transitions per block at one instant counts as stuck.
MAX_AT_ONCE = 8
# Row of `EventMotion.settings` that is 1 for blocks that stick.
STICKS = 3


class EventMotion:
    """A chain in motion, with the arrays of a third-party solver.

    `y`, shape (2 N,), is the state. The rows of `settings` are MODE, MOBILITY and
    FRICTION of `columns`, and STICKS.
    """

    def __init__(self, chain: Chain, duration: float, until: str | None) -> None:
        self.chain = chain
        self.tau = time_unit(chain)
        self.motion = motion_from_rest(chain, duration, until, scaled=True)
        self.system = self.motion.system
        self.state = self.motion.state
        self.y = np.zeros(2 * chain.n_blocks)
        self.settings = np.zeros_like(self.state)
        self.slides = False
        self.evaluations = 0

    def put(self, modes: ArrayLike, forces: ArrayLike, velocities: ArrayLike) -> None:
        """Set modes, spring forces [N] and velocities [N/tau], each of shape (N,)."""
        set_modes(self.system, self.state, modes)
        self.y[:] = np.concatenate([forces, velocities])
        sliding = np.flatnonzero(self.state[MODE])
        self.slides = len(sliding) > 0
        self.motion.progress["sliding"] = len(sliding)
        self.motion.progress["last"] = sliding.max(initial=0)

    def begin(self) -> bool:
        """Advance the run in closed form until block 1 slides; False if a block still
        slides, or the run ends before."""
        return not self.slides and self.switch(-1, 0.0)

    @property
    def onset(self) -> float:
        """Onset of the current or last slip event [s]."""
        return float(self.motion.progress["onset"][0])

    @property
    def remaining(self) -> float:
        """Time from the onset of the current event to the end of the run [tau]."""
        return float(self.motion.progress["remaining"][0])

    def rates(self, _time: float, y: FloatArray) -> FloatArray:
        """Right-hand side of the equations of motion for a state y."""
        result = np.empty_like(y)
        rates_of(y, self.system, self.state, result)
        return result

    def switch(self, event: int, elapsed: float) -> bool:
        """Make the transition of an event function that has reached zero, and all others
        that are due at the same time.

        Returns whether a block still slides; if none does, the slip event has ended.
        Event -1 stands for the wait until block 1 slides.
        """
        status = go_on(*self.motion, self.y, self.settings, event, elapsed)
        self.slides = status == MOVING
        if status == LOST:
            run = run_of(self.motion, self.chain)
            raise TransitionLimitError(
                f"transitions repeat without time advancing at t = {run.duration:.9g} s",
                run,
            )
        if status == PAUSED:
            self.motion = with_room(self.motion)
            self.slides = bool(self.motion.progress["sliding"][0])
        return self.slides

    def run(self) -> Result:
        """Result so far; if blocks still slide, they do so until the end of the run."""
        if self.slides:
            self.motion.progress["elapsed"] = self.remaining
            self.motion.progress["status"] = FINISHED
        return Result(run_of(self.motion, self.chain), self.evaluations)


def march_restarting(
    motion: EventMotion, next_transition: Callable[[float], tuple[float, int]]
) -> Result:
    """Run a chain with a solver that is restarted at each transition.

    `next_transition(time)` integrates the state in `motion` from a time [tau] to the
    next root of an event function. It returns the time of the root and the number of the
    function, or the end of the run and -1. It need not report a second event at the same
    instant, which is made with the first.
    """
    while motion.begin():
        time = 0.0
        while motion.slides and time < motion.remaining:
            time, event = next_transition(time)
            if event >= 0:
                motion.switch(event, time)
    return motion.run()


@inner
def take(state, y):
    """Copy a solver's state y into the columns of `state`."""
    n = state.shape[1] - 2
    for i in range(n):
        state[FORCE, i + 1] = y[i]
        state[VELOCITY, i + 1] = y[n + i]


@outer
def rates_of(y, system, state, result):
    """Right-hand side of the equations of motion."""
    take(state, y)
    n = state.shape[1] - 2
    rate = np.empty_like(state)
    rates(by_mode, system, state, n, state, rate)
    for i in range(n):
        result[i] = rate[FORCE, i + 1]
        result[n + i] = rate[VELOCITY, i + 1]


@outer
def event_functions(y, system, state, result):
    """All event functions, shape (2 N,); those of impossible transitions are 1."""
    take(state, y)
    for i in range(1, state.shape[1] - 1):
        slides = state[MODE, i] != 0.0
        net = net_force(state, i)
        result[2 * i - 2] = (
            state[MODE, i] * state[VELOCITY, i] if slides else system[STRENGTH, i] - net
        )
        result[2 * i - 1] = 1.0 if slides else system[STRENGTH, i] + net


def jacobian_of(system: FloatArray, state: FloatArray) -> FloatArray:
    """Jacobian of the equations of motion, shape (2 N, 2 N)."""
    n = state.shape[1] - 2
    net = np.eye(n) - np.eye(n, k=1)
    result = np.zeros((2 * n, 2 * n))
    result[:n, n:] = -system[SPRING, 1:-1, None] * net.T
    result[n:, :n] = state[MOBILITY, 1:-1, None] * net
    return result


@outer
def go_on(system, state, progress, record, y, settings, event, elapsed):
    """Make the transition of an event and those due at the same time, or wait (event -1)
    until block 1 slides.

    Returns MOVING if a block slides, PAUSED if the record is full, LOST if transitions
    repeat without time advancing, and another status if no block slides.
    """
    motion = SteppedMotion(system, state, progress, record)
    n = state.shape[1] - 2
    if event < 0:
        progress[0].legs = 0
        begin_leg(motion)
        status = progress[0].status
    else:
        take(state, y)
        progress[0].elapsed = elapsed
        switch(motion, event // 2 + 1)
        status = MOVING if progress[0].sliding > 0 else FINISHED
        if progress[0].at_once > MAX_AT_ONCE * n:
            status = LOST
        elif obstacle(motion) == PAUSED:
            status = PAUSED
    for i in range(n):
        if state[VELOCITY, i + 1] == 0.0:
            state[VELOCITY, i + 1] = state[MODE, i + 1] * NUDGE
        y[i] = state[FORCE, i + 1]
        y[n + i] = state[VELOCITY, i + 1]
        for row in range(STICKS):
            settings[row, i] = state[MODE + row, i + 1]
        settings[STICKS, i] = 1.0 - state[MOBILITY, i + 1]
    return status
