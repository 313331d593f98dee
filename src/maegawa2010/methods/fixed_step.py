"""A chain in motion, for compiled methods: transitions, waits while all blocks stick, and
the end of a run.

A compiled method is a function (motion, step). A leg is a series of steps up to the next
change of a mode. The method makes legs while `begin_leg` is true. `begin_leg` also
advances the run in closed form while all blocks stick.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from maegawa2010.methods.columns import (
    FORCE,
    MODE,
    STRENGTH,
    VELOCITY,
    at_rest,
    time_unit,
)
from maegawa2010.methods.compiled import apart, inner, template
from maegawa2010.methods.equations import (
    event_function,
    move_by,
    net_force,
)
from precursors.model.chain import Chain, FloatArray
from precursors.model.checks import checked_span
from precursors.solver.record import TRANSITION

FINISHED, GLOBAL_SLIP, PAUSED, DIVERGED, LOST, MOVING = range(6)
# Largest number of steps in a leg and of legs in a call, so that Ctrl-C takes effect
# within about a second.
STEPS_IN_LEG = 1000
LEGS_PER_CALL = 5000
FIRST_ROOM = 4096  # transitions

# Progress of a run. Times are counted from the onset of a slip event, in the unit of time
# of the system, because short times have smaller rounding errors.
PROGRESS = np.dtype(
    [
        ("unit", "f8"),  # [s]
        ("duration", "f8"),  # of the run [s]
        ("loading_rate", "f8"),  # K V [N/s]
        ("until_global", "i8"),  # whether the run ends with the first global slip
        ("onset", "f8"),  # of the slip event [s]
        ("remaining", "f8"),  # from the onset to the end of the run [unit]
        ("elapsed", "f8"),  # since the onset [unit]
        ("noted", "f8"),  # `elapsed` at the last transition [unit]
        ("waited", "f8"),  # from the last transition to the onset [s]
        ("transitions", "i8"),
        ("at_once", "i8"),  # transitions since time last advanced
        ("sliding", "i8"),  # number of sliding blocks
        ("was_global", "i8"),  # whether all blocks have slid at the same instant
        ("last", "i8"),  # farthest sliding block
        ("evaluations", "i8"),
        ("legs", "i8"),  # begun in this call
        ("status", "i8"),  # MOVING, or why no further leg begins
    ]
)
# A transition, and the time from the one before [s].
RECORD = np.dtype([*TRANSITION.descr, ("interval", "f8")])


class SteppedMotion(NamedTuple):
    """A chain in motion: `system` and `state` (see `columns`), the progress (one row), and
    the record of transitions."""

    system: FloatArray
    state: FloatArray
    progress: NDArray[np.void]
    record: NDArray[np.void]


def motion_from_rest(
    chain: Chain,
    duration: float,
    until: str | None,
    scaled: bool = False,
) -> SteppedMotion:
    """A chain at the start of a run; for the arguments see `march`."""
    progress = np.zeros(1, PROGRESS)
    progress["duration"] = checked_span(duration, until)
    progress["until_global"] = until is not None
    progress["unit"] = time_unit(chain) if scaled else 1.0
    progress["loading_rate"] = chain.loading_rate
    progress["remaining"] = progress["duration"] / progress["unit"]
    return SteppedMotion(
        *at_rest(chain, scaled),
        progress,
        np.empty(FIRST_ROOM + chain.n_blocks, RECORD),
    )


# Switching between stick and slip


@apart
def change_mode(motion, i, new):
    """Set a block's new mode, record the transition, and update the number of sliding
    blocks and the farthest one."""
    system = motion.system
    state = motion.state
    progress = motion.progress[0]
    progress.sliding += abs(new) - int(abs(state[MODE, i]))
    state[MODE, i] = new
    move_by(system, state, i, new)
    last = max(progress.last, i)
    while last > 0 and state[MODE, last] == 0.0:
        last -= 1
    progress.last = last
    record_transition(motion, i, new)


@inner
def record_transition(motion, i, new):
    """Append a transition to the record."""
    progress = motion.progress[0]
    row = motion.record[progress.transitions]
    row.time = progress.onset + progress.elapsed * progress.unit
    row.block = i
    row.mode = new
    row.tangential_load = motion.state[FORCE, 1]
    row.interval = progress.waited + (progress.elapsed - progress.noted) * progress.unit
    progress.noted = progress.elapsed
    progress.waited = 0.0
    progress.transitions += 1
    progress.at_once = progress.at_once + 1 if row.interval == 0.0 else 0
    if progress.sliding == motion.state.shape[1] - 2:
        progress.was_global = 1


@apart
def change_state(motion, i):
    """Release a stuck block in the direction of its net force, or stop a sliding block,
    which slips again if the force exceeds mu_s w (Eq. 5)."""
    state = motion.state
    net = net_force(state, i)
    old = int(state[MODE, i])
    new = int(np.sign(net))
    if old != 0:
        state[VELOCITY, i] = 0.0
        if not abs(net) > motion.system[STRENGTH, i]:
            new = 0
    if new != old:
        change_mode(motion, i, new)


@inner
def feels(state, last):
    """Farthest block whose net force can change: the next after the last sliding one."""
    return min(last + 1, state.shape[1] - 2)


@inner
def all_keep_their_modes(system, state, last):
    """Whether no sliding block's velocity has changed sign and no stuck block's force
    exceeds mu_s w."""
    for i in range(1, feels(state, last) + 1):  # noqa: SIM110
        if not event_function(system, state, state, i) >= 0.0:
            return False
    return True


@apart
def switch(motion, first):
    """Change the mode of block `first` (0: of none), whose event function is zero, then
    of all blocks whose event functions are negative."""
    system = motion.system
    state = motion.state
    farthest = feels(state, motion.progress[0].last)
    if first > 0:
        change_state(motion, first)
    for i in range(1, farthest + 1):
        if not event_function(system, state, state, i) >= 0.0:
            change_state(motion, i)


# Waiting, and the end of a run


@inner
def step_length(progress, step):
    """The step, cut at the end of the run."""
    return min(step, progress.remaining - progress.elapsed)


@apart
def rest(motion):
    """While all blocks stick, end the run or wait until block 1 reaches its limit.

    Returns MOVING if the run continues, or why it ends.
    """
    state = motion.state
    progress = motion.progress[0]
    if progress.was_global and progress.until_global:
        return GLOBAL_SLIP
    # The onset becomes the present instant.
    progress.onset += progress.elapsed * progress.unit
    progress.waited += (progress.elapsed - progress.noted) * progress.unit
    progress.elapsed = progress.noted = 0.0
    limit = state[FORCE, 2] + motion.system[STRENGTH, 1]
    wait = max((limit - state[FORCE, 1]) / progress.loading_rate, 0.0)
    remaining = max(progress.duration - progress.onset, 0.0)
    if wait >= remaining:
        progress.elapsed = remaining / progress.unit
        return FINISHED
    state[FORCE, 1] = limit
    progress.onset += wait
    progress.waited += wait
    progress.remaining = (progress.duration - progress.onset) / progress.unit
    return MOVING


@inner
def obstacle(motion):
    """Why no step can be made: PAUSED if the record is full, DIVERGED if numbers have
    overflowed, or else MOVING."""
    if motion.progress[0].transitions + motion.state.shape[1] > motion.record.shape[0]:
        return PAUSED
    return MOVING if math.isfinite(motion.state[FORCE, 1]) else DIVERGED


@apart
def begin_leg(motion):
    """Whether to make another leg; if not, `status` says why.

    While all blocks stick, the wait is skipped and block 1 is released.
    """
    progress = motion.progress[0]
    status = obstacle(motion) if progress.legs != LEGS_PER_CALL else PAUSED
    if status == MOVING and progress.sliding == 0:
        status = rest(motion)
        if status == MOVING:
            change_mode(motion, 1, 1)
    if status == MOVING and progress.remaining <= progress.elapsed:
        status = FINISHED
    progress.legs = progress.legs + 1 if status == MOVING else 0
    progress.status = status
    return status == MOVING


# Methods that make transitions at the end of a step only


@template
def run_in_steps(motion, step, advance, at_start, work):
    """Run with a method that makes transitions at the end of a step only.

    `advance(system, state, last, h, work)` makes a step of h [s] and returns the number
    of evaluations; a leg starts with `at_start` further ones. At the end of a step, a
    block whose velocity has changed sign stops, and sticks or turns round; a stuck block
    whose force exceeds mu_s w is released.
    """
    system = motion.system
    state = motion.state
    progress = motion.progress[0]
    while begin_leg(motion):
        progress.evaluations += at_start
        for _ in range(STEPS_IN_LEG):
            h = step_length(progress, step)
            progress.evaluations += advance(system, state, progress.last, h, work)
            progress.elapsed += h
            if h < step or not all_keep_their_modes(system, state, progress.last):
                break
        switch(motion, 0)
