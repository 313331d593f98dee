"""What every method has in common: its result, its row in the table of methods, a run made from arrays."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from precursors import kernel
from precursors.chain import Chain, FloatArray, positive
from precursors.exact import MAX_TRANSITIONS, TransitionLimitError
from precursors.integrators import forces
from precursors.run import TRANSITION, Run, States

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


def run_from(
    chain: Chain,
    duration: float,
    time: ArrayLike,
    block: ArrayLike,
    mode: ArrayLike,
    tangential_load: ArrayLike,
    intervals: ArrayLike | None = None,
) -> Run:
    """Make a run from its transitions; it knows no states between them.

    Parameters
    ----------
    chain : Chain
        The chain that moved, from rest with springs at natural length.
    duration : float
        Time reached [s].
    time, block, mode, tangential_load : array_like, shape (n,)
        When [s], which block (1..N), its new mode (+1, 0, -1) and F_X [N].
    intervals : array_like, shape (n + 1,), optional
        Seconds to the first transition, between them and to the end; by default differences of `time`, whose
        rounding grows with the time.
    """
    transitions = np.empty(len(np.atleast_1d(np.asarray(time))), dtype=TRANSITION)
    transitions["time"], transitions["block"], transitions["mode"] = time, block, mode
    transitions["tangential_load"] = tangential_load
    if intervals is None:
        intervals = np.diff(np.concatenate([[0.0], transitions["time"], [duration]]))
    at_rest = np.zeros(chain.n_blocks)
    return Run(
        chain=chain,
        duration=float(duration),
        transitions=transitions,
        intervals=np.array(intervals, dtype=np.float64),
        start_positions=at_rest,
        start_velocities=at_rest,
        states=_no_states(chain),
    )


def march(
    method: Callable[..., int],
    chain: Chain,
    duration: float,
    until: str | None,
    *parameters: Any,
    max_transitions: int = MAX_TRANSITIONS,
) -> Result:
    """Run a compiled fixed-step method from rest, with more room for transitions whenever it asks for it.

    Parameters
    ----------
    method : compiled function
        (system, state, record, clock, count, duration, until_global, *parameters) -> status, see `forces`.
    chain, duration, until
        As in `precursors.simulate`.
    parameters
        The method's own: its step [s] and what else it has.

    Raises
    ------
    ValueError
        If an argument is out of range.
    DivergedError
        If the numbers overflow.
    TransitionLimitError
        If there are more than `max_transitions`.
    """
    duration = positive("duration", duration, "s")
    if until not in (None, "global slip"):
        raise ValueError(f'until = {until!r} is unknown: allowed is None or "global slip"')
    positive("step", parameters[0], "s")
    system = forces.system_of(chain)
    state = forces.at_rest(system)
    clock, count = np.zeros(forces.CLOCK_SIZE), np.zeros(forces.COUNT_SIZE, np.int64)
    record = forces.new_record(FIRST_ROOM)
    status = forces.PAUSED
    while status == forces.PAUSED and count[forces.TRANSITIONS] < max_transitions:
        record = forces.with_room(record, int(count[forces.TRANSITIONS]), chain.n_blocks)
        status = method(system, state, record, clock, count, duration, until is not None, *parameters)
    n = int(count[forces.TRANSITIONS])
    if status == forces.DIVERGED:
        n = int(np.isfinite(record.tangential_load[:n]).sum())
    reached = clock[forces.ONSET] + clock[forces.ELAPSED]
    since = clock[forces.CARRIED] + (clock[forces.ELAPSED] - clock[forces.NOTED])
    since += record.interval[n : int(count[forces.TRANSITIONS])].sum()
    run = run_from(
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


def _no_states(chain: Chain) -> States:
    columns = kernel.width(chain.n_blocks)
    none: FloatArray = np.empty((0, columns))
    return States(none, none, np.empty((0, columns), np.int64), np.empty(0, np.int64), np.empty(0))
