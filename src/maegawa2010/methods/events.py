"""State, equations and event functions for third-party solvers, and the switching.

Such a solver gets y = (T_1..T_N, v_1..v_N) in N and N/tau, without the columns of the
drive and of the free end, which would count in its error norm. Its relative tolerance
means the same at 0 s and at 10 s, as each slip event has its own time, counted from its
onset in tau.

An event function falls through zero at a transition. Function 2 i (i from 0) is the
velocity of block i + 1 in the direction of its mode while it slides, and its margin
mu_s w - F against being released forward while it sticks; function 2 i + 1 is its
margin against being released backward."""

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

# A block that starts gets this velocity [N/tau] in the direction of its acceleration.
# From exactly zero, a solver that brackets the stop within its first step takes the
# start for the root: SciPy's brentq returns it and the block never gets away; heyoka's
# finds it, drops it for its direction and misses the stop.
NUDGE = math.sqrt(np.finfo(float).tiny)
# More transitions per block at one instant are a solver that has lost its way.
MAX_AT_ONCE = 8
# Rows of the settings: the rows of the state from MODE on, and 1 for blocks that stick.
STICKS = 3


class EventMotion:
    """A chain in motion, with the numbers that a solver carries, or keeps itself.

    `y`, shape (2 N,), is the state; `settings` is what each block does: the rows MODE,
    MOBILITY and FRICTION of `columns`, and STICKS.
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
        """Put the blocks into modes, the springs under forces [N], and give velocities
        [N/tau], each (N,)."""
        set_modes(self.system, self.state, modes)
        self.y[:] = np.concatenate([forces, velocities])
        sliding = np.flatnonzero(self.state[MODE])
        self.slides = len(sliding) > 0
        self.motion.progress["sliding"] = len(sliding)
        self.motion.progress["last"] = sliding.max(initial=0)

    def begin(self) -> bool:
        """Wait in closed form until block 1 slides; False if the run ends before or
        while a block slides."""
        return not self.slides and self.switch(-1, 0.0)

    @property
    def onset(self) -> float:
        """Onset of the present or last slip event [s]."""
        return float(self.motion.progress["onset"][0])

    @property
    def remaining(self) -> float:
        """Time from the onset of the present event to the end of the run [tau]."""
        return float(self.motion.progress["remaining"][0])

    def rates(self, _time: float, y: FloatArray) -> FloatArray:
        """Right-hand side of the equations of motion in a state y."""
        result = np.empty_like(y)
        rates_of(y, self.system, self.state, result)
        return result

    def switch(self, event: int, elapsed: float) -> bool:
        """Make the transition of an event function that has reached zero, and any that
        is overdue with it.

        Returns whether a block still slides; if none does, the slip event has ended.
        Event -1 is the wait.
        """
        status = go_on(*self.motion, self.y, self.settings, event, elapsed)
        self.slides = status == MOVING
        if status == LOST:
            run = run_of(self.motion, self.chain)
            raise TransitionLimitError(
                f"the solver makes transition after transition at t = {run.duration:.9g} s",
                run,
            )
        if status == PAUSED:
            self.motion = with_room(self.motion)
            self.slides = bool(self.motion.progress["sliding"][0])
        return self.slides

    def run(self) -> Result:
        """Transitions and cost so far: of a run that is over, or goes on to its end in
        its present modes."""
        if self.slides:
            self.motion.progress["elapsed"] = self.remaining
            self.motion.progress["status"] = FINISHED
        return Result(run_of(self.motion, self.chain), self.evaluations)


def march_restarting(
    motion: EventMotion, next_transition: Callable[[float], tuple[float, int]]
) -> Result:
    """Run a chain by a solver that is started anew at each transition.

    `next_transition(time)` integrates the state in `motion` from a time [tau] to the
    next root of an event function. It returns the time of that and the function's
    number, or the end of the run and -1. If another has fired at the same instant, it
    is overdue after this one or fires again at once.
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
    """Take over a solver's state."""
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
    """All event functions, shape (2 N,); what cannot happen is 1."""
    take(state, y)
    for i in range(1, state.shape[1] - 1):
        slides = state[MODE, i] != 0.0
        net = net_force(state, i)
        result[2 * i - 2] = (
            state[MODE, i] * state[VELOCITY, i] if slides else system[STRENGTH, i] - net
        )
        result[2 * i - 1] = 1.0 if slides else system[STRENGTH, i] + net


def jacobian_of(system: FloatArray, state: FloatArray) -> FloatArray:
    """Matrix of the equations of motion, shape (2 N, 2 N)."""
    n = state.shape[1] - 2
    net = np.eye(n) - np.eye(n, k=1)
    result = np.zeros((2 * n, 2 * n))
    result[:n, n:] = -system[SPRING, 1:-1, None] * net.T
    result[n:, :n] = state[MOBILITY, 1:-1, None] * net
    return result


@outer
def go_on(system, state, progress, record, y, settings, event, elapsed):
    """Make the transition of an event and those overdue with it, or wait (-1) until
    block 1 slides.

    Returns MOVING where a block slides, PAUSED where the record is full, and LOST where
    transitions repeat without time going on.
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
