"""Simulate chains exactly: every transition between stick and slip, to rounding."""

from __future__ import annotations

import math
import threading
from collections.abc import Sequence
from typing import Any, NamedTuple, Protocol, TypeVar, overload, runtime_checkable

import numpy as np
from numpy.typing import ArrayLike, NDArray

from precursors.model.chain import Chain, FloatArray
from precursors.model.checks import (
    LARGEST,
    Until,
    checked_span,
    number_array,
    positive,
    whole,
)
from precursors.solver import kernel
from precursors.solver.kernel.arrays import Progress
from precursors.solver.record import TRANSITION, IntArray, States, room_for_states
from precursors.solver.run import Record, Run
from precursors.support.waiting import tell

MAX_TRANSITIONS = 10_000_000
# Stored states are thinned out so that they never take more room than this.
STATES_BYTES = 64 * 2**20
# The kernel returns after so many windows, so that Ctrl-C is heard within about a
# second.
WINDOWS_PER_CALL = 500_000
# Blocks that slide without end would keep the kernel busy for ever: some 10 minutes at
# N = 10.
MAX_WINDOWS = 1_000_000_000
# Transitions that a run may have before it gets a record of its own, and that a
# thread's record has room for.
FIRST_ROOM = 2048
SHARED_ROOM = 16384


Own = TypeVar("Own", covariant=True)  # what a chain with its own solver gives


class _End(NamedTuple):
    """Where runs end: at a time [s], after a global slip, in a slip so long [s], at so
    many transitions."""

    duration: float
    until_global: bool
    longest_slip: float
    most: int


class TransitionLimitError(RuntimeError):
    """A run met its cap on transitions or on work; `run` holds what was computed up to
    there."""

    def __init__(self, message: str, run: Record) -> None:
        super().__init__(message)
        self.run = run


@runtime_checkable
class OwnSolver(Protocol[Own]):
    """A chain that is not solved here, such as `LargerChain`."""

    def simulate(self, duration: float, until: Until, **limits: int) -> Own:
        """Run it from rest."""


@overload
def simulate(chain: Chain, *how: Any, **more: Any) -> Run: ...
@overload
def simulate(chain: OwnSolver[Own], *how: Any, **more: Any) -> Own: ...
def simulate(
    chain: Chain | OwnSolver[Any],
    duration: float = 10.0,
    until: Until = None,
    start_positions: ArrayLike | None = None,
    start_velocities: ArrayLike | None = None,
    max_transitions: int = MAX_TRANSITIONS,
    longest_slip: float | None = None,
) -> Any:
    """Run a chain from rest, or from a given start, through all its transitions (Eqs.
    2-6).

    Parameters
    ----------
    chain : Chain or LargerChain
        The chain, which says how it is solved: exactly, or with steps.
    duration : float
        Time to run [s]; with `until`, the limit.
    until : "global slip", optional
        Stop at the end of the first event in which all blocks slide at the same
        instant.
    start_positions, start_velocities : array_like, shape (N,), optional
        Positions [m] relative to springs at natural length, and velocities [m/s], at
        time 0; zero by default.
    max_transitions : int
        Cap on the number of transitions.
    longest_slip : float, optional
        Stop when one slip event has lasted so long [s]: some runs of many blocks never
        come to rest again.

    Returns
    -------
    Run or LargerRun
        The transitions and the states between them; of a larger chain, its load and
        what half the step changes.

    Raises
    ------
    TransitionLimitError
        If the cap, or one on the work of chains that hardly ever rest, is met; its
        attribute `run` holds what was computed.
    """
    if isinstance(chain, OwnSolver):
        refuse_for_own(start_positions, start_velocities, longest_slip)
        return chain.simulate(duration, until, max_transitions=max_transitions)
    end = checked_end([chain], duration, until, max_transitions, longest_slip)
    positions = checked_start("start_positions", start_positions, "m", chain)
    velocities = checked_start("start_velocities", start_velocities, "m/s", chain)
    return run_batch([chain], positions[None], velocities[None], end)[0]


def refuse_for_own(*given: object) -> None:
    """Refuse what is known of exact runs only."""
    if any(value is not None for value in given):
        raise ValueError("a start and longest_slip can only be given for a Chain")


def checked_end(
    chains: Sequence[Chain],
    duration: float,
    until: Until,
    most: int,
    longest_slip: float | None,
) -> _End:
    """Check what is simulated and where it ends."""
    for chain in chains:
        if not isinstance(chain, Chain):
            raise TypeError(
                f"what is simulated must be a Chain, but is {type(chain).__name__}"
            )
    longest = (
        math.inf
        if longest_slip is None
        else positive("longest_slip", longest_slip, "s")
    )
    most = whole("max_transitions", most, at_least=1)
    return _End(checked_span(duration, until), until is not None, longest, most)


def checked_start(
    name: str, values: ArrayLike | None, unit: str, chain: Chain
) -> FloatArray:
    """Check positions or velocities at the start; zero by default."""
    if values is None:
        return np.zeros(chain.n_blocks)
    start = number_array(name, values, unit)
    if start.shape != (chain.n_blocks,):
        raise ValueError(
            f"{name} must have shape ({chain.n_blocks},), one [{unit}] a block, but have {start.shape}"
        )
    if not (abs(start) <= LARGEST).all():
        raise ValueError(
            f"{name} must be finite, and not beyond {LARGEST:g} {unit}, but are {start}"
        )
    return start


class _Workspace(NamedTuple):
    """Memory, record and states for chains of one length; a state is stored after
    `stride` transitions."""

    n_blocks: int
    stride: int
    memory: FloatArray
    record: NDArray[np.void]
    words: IntArray
    states: FloatArray


_own = threading.local()


def _workspace_for(n_blocks: int) -> _Workspace:
    """The workspace of this thread, kept from call to call."""
    work: _Workspace | None = vars(_own).get("workspace")
    if work is None or work.n_blocks != n_blocks:
        # Storing takes little time beside finding so many transitions.
        stride = max(10, 1 + n_blocks // 3)
        record = np.empty(max(SHARED_ROOM, 2 * n_blocks), kernel.ROW)
        states = room_for_states(max(SHARED_ROOM // stride, 2), n_blocks)
        memory = kernel.memory_for(n_blocks)
        words = kernel.words(record)
        work = _own.workspace = _Workspace(
            n_blocks, stride, memory, record, words, states
        )
    return work


# What was recorded of one run: transitions, intervals [s] and states.
_Part = tuple[NDArray[np.void], FloatArray, States]


def run_batch(
    chains: Sequence[Chain], positions: FloatArray, velocities: FloatArray, end: _End
) -> list[Run]:
    """Run chains of equal length one after the other, in as few calls of the kernel as
    it takes."""
    work = _workspace_for(chains[0].n_blocks)
    n = len(chains)
    parameters = np.array([kernel.parameters(chain) for chain in chains])
    batch = kernel.Batch(
        parameters, np.array([chain.weights for chain in chains]), positions, velocities
    )
    progress = np.zeros(n, kernel.PROGRESS)
    limits = kernel.Limits(
        end.duration,
        end.until_global,
        end.longest_slip,
        min(FIRST_ROOM, end.most),
        max(FIRST_ROOM // work.stride, 2),
        WINDOWS_PER_CALL,
        work.stride,
        False,
    )
    runs: list[Run] = []
    while (done := len(runs)) < n:
        here = _rows(batch, slice(done, None)) if done else batch
        reached = progress[done:]
        n_finished, is_paused = kernel.run_batch(
            here, limits, kernel.words(reached), work.words, work.states, work.memory
        )
        parts = _parts(work, reached[:n_finished]) if n_finished else []
        if is_paused:
            finished = reached[:n_finished]
            last = slice(n_finished, n_finished + 1)
            record = work.record[int((finished["transitions"] + 1).sum()) :]
            states = work.states[int(finished["stored"].sum()) :]
            rest = work._replace(record=record, states=states)
            parts.append(
                _go_on(_rows(here, last), limits, reached[last], rest, end.most)
            )
        for j, part in enumerate(parts, done):
            run = _run(chains[j], positions[j], velocities[j], progress[j], part, end)
            if progress["status"][j] == kernel.PAUSED:
                raise _unfinished(run, end)
            runs.append(run)
    return runs


def _run(
    chain: Chain,
    positions: FloatArray,
    velocities: FloatArray,
    last: np.void,
    part: _Part,
    end: _End,
) -> Run:
    """A run from its start, where it ended, and what was recorded of it."""
    transitions, intervals, states = part
    time = float(last["onset"] + (last["onset_error"] + last["elapsed"] * last["tau"]))
    return Run(
        chain=chain,
        duration=end.duration if last["status"] == kernel.FINISHED else time,
        transitions=transitions,
        intervals=intervals,
        start_positions=positions,
        start_velocities=velocities,
        states=states,
        evaluations=float(last["derivatives"]) / chain.n_blocks,
    )


def _unfinished(run: Run, end: _End) -> TransitionLimitError:
    """The error of a run that met a cap before its end."""
    where = f"at t = {run.duration:.9g} s of {end.duration:g} s"
    if len(run.transitions) >= end.most:
        return TransitionLimitError(
            f"max_transitions = {end.most} reached {where}, last at block {run.transitions['block'][-1]}: "
            "raise max_transitions or shorten duration",
            run,
        )
    return TransitionLimitError(
        f"{MAX_WINDOWS:g} steps made {where}, as blocks slide nearly all the time: shorten duration",
        run,
    )


def _rows(columns: Any, rows: slice) -> Any:
    """Those rows of all arrays in a named tuple."""
    return columns._make(values[rows] for values in columns)


def _parts(work: _Workspace, progress: Progress) -> list[_Part]:
    """Cut the record of several runs, as `progress` has them, into one part a run."""
    used = progress["transitions"].tolist()
    stored = progress["stored"].tolist()
    transitions, intervals = _columns(work.record[: sum(used) + len(used)])
    states = States.from_rows(work.states[: sum(stored)])
    if len(used) == 1:
        return [(transitions[:-1], intervals, states)]
    parts = []
    first = 0
    first_state = 0
    for n, m in zip(used, stored, strict=True):
        last = first + n
        last_state = first_state + m
        rows = slice(first_state, last_state)
        parts.append(
            (transitions[first:last], intervals[first : last + 1], _rows(states, rows))
        )
        first = last + 1
        first_state = last_state
    return parts


def _go_on(
    batch: Any, limits: Any, progress: Progress, rest: _Workspace, most: int
) -> _Part:
    """Run on a chain that the kernel left unfinished, in a record of its own that grows
    as needed."""
    [run], stride, duration = progress, limits.stride, limits.duration
    n = int(run["transitions"])
    stored = int(run["stored"])
    record = rest.record[: n + 1]
    states = rest.states[:stored]

    def is_unfinished() -> bool:
        return bool(
            run["status"] == kernel.PAUSED
            and run["transitions"] < most
            and run["windows"] < MAX_WINDOWS
        )

    for _ in tell(
        "running", iter(is_unfinished, False), lambda: run["onset"] / duration
    ):
        if n + 1 >= len(record):
            record = np.resize(record, 1 + min(max(FIRST_ROOM, 2 * n), most))
        if stored >= len(states):
            rows = max(FIRST_ROOM // stride, 2 * len(states))
            if rows * states.itemsize * states.shape[1] > STATES_BYTES:
                states = states[::2]
                stride = 2 * stride
                run["stored"] = len(states)
                rows = rows // 2
            states = np.resize(states, (rows, states.shape[1]))
        limits = limits._replace(
            transitions=len(record) - 1, states=len(states), stride=stride, goes_on=True
        )
        kernel.run_batch(
            batch,
            limits,
            kernel.words(progress),
            kernel.words(record),
            states,
            rest.memory,
        )
        n = int(run["transitions"])
        stored = int(run["stored"])
    record["interval"][n] = run["since"] * run["tau"]
    transitions, intervals = _columns(record[: n + 1])
    return transitions[:n], intervals, States.from_rows(states[:stored])


def _columns(record: NDArray[np.void]) -> tuple[NDArray[np.void], FloatArray]:
    """Transitions, and the intervals before them [s]."""
    transitions = np.empty(len(record), dtype=TRANSITION)
    for name in TRANSITION.names or ():
        transitions[name] = record[name]
    return transitions, record["interval"].copy()
