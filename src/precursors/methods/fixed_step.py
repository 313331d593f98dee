"""What compiled methods share that walk in steps: switching, waiting, recording, and the run itself.

A method is a compiled function (motion, step, *parameters) -> status. It works in legs: the steps up to
the next change of a mode. `begin_leg` waits while all blocks stick, and says when the run has ended."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from precursors.methods.columns import State, System, apart, at_rest, inner, resting_mode, system_of
from precursors.methods.common import DivergedError, Kind, Method, Result, Smooth
from precursors.model.chain import Chain
from precursors.model.checks import checked_span, positive
from precursors.model.switching import COULOMB
from precursors.solver.run import Run
from precursors.solver.simulate import MAX_TRANSITIONS, TransitionLimitError

FINISHED, GLOBAL_SLIP, PAUSED, DIVERGED, MOVING = range(5)
# A leg has at most so many steps, and a call so many legs, so that Ctrl-C is heard within a second or so.
STEPS_IN_LEG, LEGS_PER_CALL = 1000, 5000
FIRST_ROOM = 4096  # transitions
HAIR = 1e-12  # of a step: more than the rounding of a clock that adds thousands of them

PROGRESS = np.dtype(
    [
        ("duration", "f8"),  # of the run [s]
        ("until_global", "i8"),  # whether it ends with the first global slip
        ("onset", "f8"),  # of the slip event [s]; short times since then are not rounded as long ones
        ("elapsed", "f8"),  # since the onset [s]
        ("noted", "f8"),  # the same at the last transition [s]
        ("waited", "f8"),  # from the last transition to the onset [s]
        ("transitions", "i8"),
        ("sliding", "i8"),  # number of sliding blocks
        ("was_global", "i8"),  # whether all blocks have slid at the same instant
        ("last", "i8"),  # farthest sliding block
        ("evaluations", "i8"),
    ]
)
RECORD = np.dtype(
    [("time", "f8"), ("block", "i4"), ("mode", "i1"), ("tangential_load", "f8"), ("interval", "f8")]
)


class Motion(NamedTuple):
    """A chain in motion: what stays, what changes, how far it is, and its transitions so far."""

    system: System
    state: State
    progress: np.void
    record: NDArray[np.void]


def motion_from_rest(chain: Chain, duration: float, until: str | None, rule: str = COULOMB) -> Motion:
    """A chain at the start of its run."""
    system = system_of(chain, rule)
    progress = np.zeros(1, PROGRESS)[0]
    progress["duration"], progress["until_global"] = checked_span(duration, until), until is not None
    return Motion(system, at_rest(system), progress, np.empty(FIRST_ROOM, RECORD))


# Switching between stick and slip


@inner
def set_mode(motion, i, new):
    """Set a block's new mode; the number of sliding blocks and the farthest one follow."""
    state, progress = motion.state, motion.progress
    old = state.mode[i]
    state.mode[i] = new
    state.mobility[i] = motion.system.inverse_mass if new != 0 else 0.0
    state.friction[i] = new * motion.system.kinetic_friction[i]
    progress.sliding += abs(new) - abs(old)
    if progress.sliding == state.mode.shape[0] - 2:
        progress.was_global = 1
    last = max(progress.last, i)
    while last > 0 and state.mode[last] == 0:
        last -= 1
    progress.last = last


@apart
def record_transition(motion, i, new):
    """Write down a transition."""
    progress, row = motion.progress, motion.record[motion.progress.transitions]
    row.time = progress.onset + progress.elapsed
    row.block, row.mode, row.tangential_load = i, new, motion.state.spring_force[1]
    row.interval = progress.waited + (progress.elapsed - progress.noted)
    progress.noted, progress.waited = progress.elapsed, 0.0
    progress.transitions += 1


@apart
def change_mode(motion, i, new):
    """Set a block's new mode and record it."""
    set_mode(motion, i, new)
    record_transition(motion, i, new)


@inner
def all_keep_their_modes(system, state, last):
    """Whether no sliding block's velocity has changed its sign and no stuck block's force exceeds mu_s w.

    Beyond the block after the last that slides no force changes, so no block is released there.
    """
    force, velocity, mode, backward = state.spring_force, state.velocity, state.mode, system.backward
    for i in range(1, min(last + 1, mode.shape[0] - 2) + 1):
        if mode[i] != 0:
            if not velocity[i] * mode[i] >= 0.0:
                return False
        elif not -backward[i] <= force[i] - force[i + 1] <= system.strength[i]:
            return False
    return True


@apart
def switch(motion):
    """Change modes at the end of a step: a block whose velocity has changed its sign stops or turns round."""
    state = motion.state
    for i in range(1, min(motion.progress.last + 1, state.mode.shape[0] - 2) + 1):
        old = state.mode[i]
        if old != 0:
            if state.velocity[i] * old >= 0.0:
                continue
            state.velocity[i] = 0.0
        new = resting_mode(motion.system, state, i)
        if new != old:
            change_mode(motion, i, new)


# Waiting, and the end of a run


@inner
def step_length(progress, step):
    """The step [s], cut at the end of the run."""
    return min(step, progress.duration - progress.onset - progress.elapsed)


@inner
def start_clock(progress):
    """Count the time from now on."""
    progress.onset += progress.elapsed
    progress.waited += progress.elapsed - progress.noted
    progress.elapsed = progress.noted = 0.0


@apart
def rest(motion, waits):
    """All blocks stick: end the run, or wait in closed form (where `waits`) until block 1 is at its limit.

    Returns MOVING where the run goes on.
    """
    system, force, progress = motion.system, motion.state.spring_force, motion.progress
    if progress.was_global and progress.until_global:
        return GLOBAL_SLIP
    if progress.noted > 0.0 or waits:
        start_clock(progress)
    if not waits:
        return MOVING
    loading_rate = system.spring[1] * system.drive_velocity
    limit = force[2] + system.strength[1]
    wait = max((limit - force[1]) / loading_rate, 0.0)
    remaining = max(progress.duration - progress.onset, 0.0)
    if wait >= remaining:
        force[1] += loading_rate * remaining
        progress.elapsed = remaining
        return FINISHED
    force[1] = max(force[1], limit)
    progress.elapsed = wait
    start_clock(progress)
    return MOVING


@inner
def obstacle(motion):
    """Why no step can be made: a full record, or numbers that have overflowed; MOVING if one can."""
    if motion.progress.transitions + motion.state.mode.shape[0] > motion.record.shape[0]:
        return PAUSED
    return MOVING if math.isfinite(motion.state.spring_force[1]) else DIVERGED


@apart
def begin_leg(motion, waits):
    """Whether steps are to be made (MOVING) or why not; where all blocks stick, wait and release block 1."""
    status = obstacle(motion)
    if status == MOVING and motion.progress.sliding == 0:
        status = rest(motion, waits)
        if status == MOVING and waits:
            change_mode(motion, 1, 1)
    if status == MOVING and step_length(motion.progress, motion.progress.duration) <= 0.0:
        return FINISHED
    return status


# Methods that switch once a step


@inner
def run_in_steps(motion, step, waits, advance, starts, work):
    """Run until the end, a full record or a spent budget of legs.

    `advance(system, state, last, h, work)` makes a step of h [s] and returns the evaluations made. If it
    `starts`, a leg begins with a step of no length, which evaluates the forces. A block whose velocity has
    changed its sign at the end of a step is stopped there, and sticks or turns round; a stuck block whose
    force exceeds mu_s w at the end of a step is released there. While all blocks stick each step is made as
    well, or (`waits`) the wait is in closed form.
    """
    system, state, progress = motion.system, motion.state, motion.progress
    for _ in range(LEGS_PER_CALL):
        status = begin_leg(motion, waits)
        if status != MOVING:
            return status
        if starts:
            progress.evaluations += advance(system, state, progress.last, 0.0, work)
        for _ in range(STEPS_IN_LEG):
            h = step_length(progress, step)
            progress.evaluations += advance(system, state, progress.last, h, work)
            progress.elapsed += h
            if h < step or not all_keep_their_modes(system, state, progress.last):
                break
        switch(motion)
    return PAUSED


# From Python


def march(
    method: Callable[..., int],
    parameters: tuple[Any, ...],
    chain: Chain,
    duration: float,
    step: float,
    until: str | None = None,
    max_transitions: int = MAX_TRANSITIONS,
    rule: str = COULOMB,
) -> Result:
    """Run a compiled fixed-step method from rest.

    Parameters
    ----------
    method : compiled function
        (motion, step, *parameters) -> status.
    parameters
        What the method has besides its step.
    chain, duration, until
        As in `precursors.simulate`.
    step : float
        Step [s].
    rule : str
        A key of `SWITCHING_RULES`.

    Raises
    ------
    ValueError
        If an argument is out of range.
    DivergedError
        If the numbers overflow.
    TransitionLimitError
        If there are more than `max_transitions`.
    """
    positive("step", step, "s")
    motion = motion_from_rest(chain, duration, until, rule)
    progress = motion.progress
    status = PAUSED
    while status == PAUSED and progress["transitions"] < max_transitions:
        if progress["transitions"] + chain.n_blocks + 2 > len(motion.record):
            motion = motion._replace(record=np.resize(motion.record, 2 * len(motion.record) + chain.n_blocks))
        status = method(motion, step, *parameters)
    run = _run_of(motion, chain, status)
    if status == DIVERGED:
        raise DivergedError(f"the numbers overflow at t = {_reached(progress):.9g} s: shorten the step", run)
    if status == PAUSED:
        raise TransitionLimitError(
            f"max_transitions = {max_transitions} reached at t = {_reached(progress):.9g} s", run
        )
    return Result(run, int(progress["evaluations"]))


def slide(
    method: Callable[..., int],
    parameters: tuple[Any, ...],
    system: System,
    state: State,
    step: float,
    n_steps: int,
) -> None:
    """Make n steps [s] of all blocks as they slide in a state, without switching, by the code of `march`.

    Blocks that count as stuck, that nothing holds and that nothing releases keep their motion and their mode.
    """
    never = np.full_like(system.strength, np.inf)
    free = system._replace(strength=never, backward=never)
    progress = np.zeros(1, PROGRESS)[0]
    progress["sliding"] = progress["last"] = len(state.mode) - 2
    # The clock adds step after step; the last is shorter by a hair, so that none of no length follows.
    progress["duration"] = np.cumsum(np.append(0.0, np.full(n_steps, step)))[-1] - HAIR * step
    stuck = state._replace(mode=np.zeros_like(state.mode))
    motion = Motion(free, stuck, progress, np.empty(FIRST_ROOM, RECORD))
    while method(motion, step, *parameters) == PAUSED:
        pass


def _reached(progress: np.void) -> float:
    return float(progress["onset"] + progress["elapsed"])


def _run_of(motion: Motion, chain: Chain, status: int) -> Run:
    """The run so far; of a diverged one what is finite."""
    progress, rows = motion.progress, motion.record[: motion.progress["transitions"]]
    n = len(rows)
    if status == DIVERGED:
        n = int(np.isfinite(rows["tangential_load"]).sum())
    since = progress["waited"] + (progress["elapsed"] - progress["noted"]) + rows["interval"][n:].sum()
    good, intervals = rows[:n], np.append(rows["interval"][:n], since)
    duration = float(progress["duration"]) if status == FINISHED else _reached(progress)
    load = good["tangential_load"]
    return Run.from_transitions(chain, duration, good["time"], good["block"], good["mode"], load, intervals)


def fixed_step(
    name: str,
    label: str,
    method: Callable[..., int],
    *parameters: Any,
    smooth: tuple[int, float, Callable[[float], float]] | None = None,
    kind: Kind = "once a step",
    **others: Any,
) -> Method:
    """Make the row of a compiled fixed-step method.

    `method` and its parameters are those of `march`; `smooth` is order, limit and energy factor of `Smooth`.
    """
    return Method(
        name,
        label,
        "step [s]",
        partial(march, method, parameters),
        smooth=Smooth(partial(slide, method, parameters), *smooth) if smooth else None,
        kind=kind,
        **others,
    )
