"""Run compiled fixed-step methods, and make a `Method` of them."""

from collections.abc import Callable
from functools import partial

import numpy as np

from maegawa2010.methods.common import DivergedError, Method, Result, Smooth
from maegawa2010.methods.fixed_step import (
    DIVERGED,
    FINISHED,
    FIRST_ROOM,
    PAUSED,
    PROGRESS,
    RECORD,
    SteppedMotion,
    motion_from_rest,
)
from precursors.model.chain import Chain, FloatArray
from precursors.model.checks import positive
from precursors.solver.record import TRANSITION
from precursors.solver.run import Record
from precursors.solver.simulate import MAX_TRANSITIONS, TransitionLimitError


def march(
    method: Callable[..., None],
    chain: Chain,
    duration: float,
    step: float,
    until: str | None = None,
    max_transitions: int = MAX_TRANSITIONS,
) -> Result:
    """Run a compiled method, a function (motion, step [s]), from rest.

    For the other arguments see `precursors.simulate`.

    Raises
    ------
    ValueError, DivergedError, TransitionLimitError
        If an argument is out of range, the numbers overflow, or there are more
        transitions than `max_transitions`.
    """
    positive("step", step, "s")
    motion = motion_from_rest(chain, duration, until)
    status = PAUSED
    while status == PAUSED and motion.progress["transitions"][0] < max_transitions:
        motion = with_room(motion)
        method(motion, step)
        status = int(motion.progress["status"][0])
    run = run_of(motion, chain)
    if status == DIVERGED:
        raise DivergedError(
            f"the numbers overflow at t = {run.duration:.9g} s: shorten the step", run
        )
    if status == PAUSED:
        raise TransitionLimitError(
            f"max_transitions = {max_transitions} reached at t = {run.duration:.9g} s",
            run,
        )
    return Result(run, int(motion.progress["evaluations"][0]))


def slide(
    method: Callable[..., None],
    system: FloatArray,
    state: FloatArray,
    step: float,
    n_steps: int,
) -> None:
    """Make `n_steps` steps [s] without transitions from a state of `sliding_forward`, with
    the same code as `march`."""
    progress = np.zeros(1, PROGRESS)
    progress["sliding"] = progress["last"] = state.shape[1] - 2
    progress["remaining"] = n_steps * step
    progress["status"] = PAUSED
    motion = SteppedMotion(system, state, progress, np.empty(FIRST_ROOM, RECORD))
    while progress["status"] == PAUSED:
        method(motion, step)


def with_room(motion: SteppedMotion) -> SteppedMotion:
    """The motion, with a longer record if its own is full."""
    if motion.progress["transitions"][0] + motion.state.shape[1] <= len(motion.record):
        return motion
    return motion._replace(
        record=np.resize(motion.record, 2 * len(motion.record) + motion.state.shape[1])
    )


def run_of(motion: SteppedMotion, chain: Chain) -> Record:
    """The run so far; if it diverged, its finite part."""
    progress = motion.progress[0]
    rows = motion.record[: progress["transitions"]]
    unit = progress["unit"]
    n = int(np.isfinite(rows["tangential_load"]).sum())
    since = progress["waited"] + (progress["elapsed"] - progress["noted"]) * unit
    # The last interval includes the intervals of transitions that are left out.
    intervals = [*rows["interval"][:n], rows["interval"][n:].sum() + since]
    reached = (
        progress["duration"]
        if progress["status"] == FINISHED
        else progress["onset"] + progress["elapsed"] * unit
    )
    columns = {name: rows[name][:n] for name in TRANSITION.names or ()}
    return Record.from_columns(chain, float(reached), **columns, intervals=intervals)


def fixed_step(
    name: str,
    method: Callable[..., None],
    smooth: tuple[float, Callable[[float], float]] | None = None,
) -> Method:
    """Make a `Method` of a compiled fixed-step method (see `march`); `smooth` has `limit`
    and `energy_factor` of `Smooth`."""
    return Method(
        name,
        "step [s]",
        partial(march, method),
        smooth=Smooth(partial(slide, method), *smooth) if smooth else None,
    )
