"""What every method has in common: its result, its row in the table of methods, the loop of fixed steps."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from precursors.methods import forces
from precursors.model.chain import Chain, checked_span, positive
from precursors.solver.run import Run
from precursors.solver.simulate import MAX_TRANSITIONS, TransitionLimitError

FIRST_ROOM = 4096


@dataclass(frozen=True)
class Result:
    """What a method returns.

    Attributes
    ----------
    run : Run
        Transitions, intervals, chain and duration; no states, so that `run.at` refuses.
    evaluations : int
        Evaluations of the forces of the whole chain: the cost that does not depend on the machine.
    """

    run: Run
    evaluations: int


@dataclass(frozen=True)
class Method:
    """A row of the table of methods.

    Attributes
    ----------
    name, label : str
        Key in the table; name in charts.
    knob : str
        What sets the accuracy, with its unit: "step [s]", "relative tolerance", ...
    sweep : tuple of float
        Values of the knob worth charting, from loose to tight.
    solve : callable
        (chain, duration [s], knob, until) -> Result; `until` is None or "global slip".
    """

    name: str
    label: str
    knob: str
    sweep: tuple[float, ...]
    solve: Callable[[Chain, float, float, str | None], Result]


class DivergedError(RuntimeError):
    """The numbers overflowed; `run` holds what was computed up to there."""

    def __init__(self, message: str, run: Run) -> None:
        super().__init__(message)
        self.run = run


def fixed_step(
    name: str, label: str, steps: tuple[float, ...], method: Callable[..., int], *parameters: Any
) -> Method:
    """Make the row of a compiled fixed-step method; `method` and its parameters are those of `march`."""
    return Method(name, label, "step [s]", steps, partial(march, method, parameters))


def march(
    method: Callable[..., int],
    parameters: tuple[Any, ...],
    chain: Chain,
    duration: float,
    step: float,
    until: str | None = None,
    max_transitions: int = MAX_TRANSITIONS,
) -> Result:
    """Run a compiled fixed-step method from rest, with more room for transitions whenever it asks for it.

    Parameters
    ----------
    method : compiled function
        (system, state, record, clock, count, duration, until_global, step, *parameters) -> status, see
        `forces`.
    parameters
        What the method has besides its step.
    chain, duration, until
        As in `precursors.simulate`.
    step : float
        Step [s].

    Raises
    ------
    ValueError
        If an argument is out of range.
    DivergedError
        If the numbers overflow.
    TransitionLimitError
        If there are more than `max_transitions`.
    """
    duration = checked_span(duration, until)
    positive("step", step, "s")
    system = forces.system_of(chain)
    state = forces.at_rest(system)
    clock, count = np.zeros(forces.CLOCK_SIZE), np.zeros(forces.COUNT_SIZE, np.int64)
    record = forces.new_record(FIRST_ROOM)
    status = forces.PAUSED
    while status == forces.PAUSED and count[forces.TRANSITIONS] < max_transitions:
        record = forces.with_room(record, int(count[forces.TRANSITIONS]), chain.n_blocks)
        status = method(system, state, record, clock, count, duration, until is not None, step, *parameters)
    n = int(count[forces.TRANSITIONS])
    if status == forces.DIVERGED:
        n = int(np.isfinite(record.tangential_load[:n]).sum())
    reached = clock[forces.ONSET] + clock[forces.ELAPSED]
    since = clock[forces.CARRIED] + (clock[forces.ELAPSED] - clock[forces.NOTED])
    since += record.interval[n : int(count[forces.TRANSITIONS])].sum()
    run = Run.from_transitions(
        chain,
        duration if status == forces.FINISHED else float(reached),
        record.time[:n],
        record.block[:n],
        record.mode[:n],
        record.tangential_load[:n],
        np.append(record.interval[:n], since),
    )
    if status == forces.DIVERGED:
        raise DivergedError(
            f"the motion grows beyond all numbers at t = {reached:.9g} s: shorten the step", run
        )
    if status == forces.PAUSED:
        raise TransitionLimitError(f"max_transitions = {max_transitions} reached at t = {reached:.9g} s", run)
    return Result(run, int(count[forces.EVALUATIONS]))
