"""Chains of equal length through the compiled kernel, and what it recorded as runs."""

from __future__ import annotations

import threading
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from precursors.model.chain import Chain, FloatArray
from precursors.solver import kernel
from precursors.solver.kernel.arrays import Progress
from precursors.solver.record import TRANSITION, IntArray, States, room_for_states
from precursors.solver.run import Record, Run
from precursors.support.waiting import tell

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


class End(NamedTuple):
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
    chains: Sequence[Chain], positions: FloatArray, velocities: FloatArray, end: End
) -> list[Run]:
    """Run chains of equal length one after the other, in as few calls of the kernel as
    it takes."""
    work = _workspace_for(chains[0].n_blocks)
    batch = kernel.Batch(
        parameters=np.array([kernel.parameters(chain) for chain in chains]),
        weights=np.array([chain.weights for chain in chains]),
        positions=positions,
        velocities=velocities,
    )
    limits = kernel.Limits(
        duration=end.duration,
        until_global=end.until_global,
        longest_slip=end.longest_slip,
        transitions=min(FIRST_ROOM, end.most),
        states=max(FIRST_ROOM // work.stride, 2),
        windows=WINDOWS_PER_CALL,
        stride=work.stride,
        goes_on=False,
    )
    progress = np.zeros(len(chains), kernel.PROGRESS)
    runs: list[Run] = []
    while len(runs) < len(chains):
        reached = progress[len(runs) :]
        n_finished, is_paused = kernel.run_batch(
            _rows(batch, slice(len(runs), None)) if runs else batch,
            limits,
            kernel.words(reached),
            work.words,
            work.states,
            work.memory,
        )
        parts = _parts(work, reached[:n_finished])
        if is_paused:
            paused = slice(len(runs) + n_finished, len(runs) + n_finished + 1)
            rest = _unused(work, reached[:n_finished])
            parts.append(
                _go_on(_rows(batch, paused), limits, progress[paused], rest, end.most)
            )
        for part in parts:
            runs.append(_run(chains, batch, progress, len(runs), part, end))
    return runs


def _run(
    chains: Sequence[Chain],
    batch: kernel.Batch,
    progress: Progress,
    j: int,
    part: _Part,
    end: End,
) -> Run:
    """Run j of a batch, of which `part` was recorded; an error if it met a cap."""
    transitions, intervals, states = part
    last = progress[j]
    reached = last["onset"] + (last["onset_error"] + last["elapsed"] * last["tau"])
    run = Run(
        chain=chains[j],
        duration=end.duration if last["status"] == kernel.FINISHED else float(reached),
        transitions=transitions,
        intervals=intervals,
        start_positions=batch.positions[j],
        start_velocities=batch.velocities[j],
        states=states,
        evaluations=float(last["derivatives"]) / chains[j].n_blocks,
    )
    if last["status"] == kernel.PAUSED:
        raise _unfinished(run, end)
    return run


def _unfinished(run: Run, end: End) -> TransitionLimitError:
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
    if len(used) == 1:  # the usual case, without slices
        return [(transitions[:-1], intervals, states)]
    parts = []
    first = 0
    first_state = 0
    for n, n_states in zip(used, stored, strict=True):
        of_run = slice(first, first + n)
        with_end = slice(first, first + n + 1)
        of_states = slice(first_state, first_state + n_states)
        parts.append(
            (transitions[of_run], intervals[with_end], _rows(states, of_states))
        )
        first = with_end.stop
        first_state = of_states.stop
    return parts


def _unused(work: _Workspace, progress: Progress) -> _Workspace:
    """The workspace without what some finished runs have recorded."""
    record = work.record[int((progress["transitions"] + 1).sum()) :]
    return work._replace(
        record=record, states=work.states[int(progress["stored"].sum()) :]
    )


def _go_on(
    batch: Any, limits: Any, progress: Progress, rest: _Workspace, most: int
) -> _Part:
    """Run on a chain that the kernel left unfinished, in a record of its own that grows
    as needed."""
    [run] = progress
    duration = limits.duration
    record = rest.record[: run["transitions"] + 1]
    states = rest.states[: run["stored"]]

    def is_unfinished() -> bool:
        return bool(
            run["status"] == kernel.PAUSED
            and run["transitions"] < most
            and run["windows"] < MAX_WINDOWS
        )

    for _ in tell(
        "running", iter(is_unfinished, False), lambda: run["onset"] / duration
    ):
        record = _with_room(record, int(run["transitions"]), most)
        states, stride = _with_room_for_states(states, run, limits.stride)
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
    record["interval"][n] = run["since"] * run["tau"]
    transitions, intervals = _columns(record[: n + 1])
    return transitions[:n], intervals, States.from_rows(states[: run["stored"]])


def _with_room(record: NDArray[np.void], n: int, most: int) -> NDArray[np.void]:
    """A record of n transitions, made longer if it is full."""
    if n + 1 < len(record):
        return record
    return np.resize(record, 1 + min(max(FIRST_ROOM, 2 * n), most))


def _with_room_for_states(
    states: FloatArray, run: np.void, stride: int
) -> tuple[FloatArray, int]:
    """Stored states, made longer if they are full, and the stride between them.

    Every second one is dropped where they would take more than `STATES_BYTES`.
    """
    if run["stored"] < len(states):
        return states, stride
    rows = max(FIRST_ROOM // stride, 2 * len(states))
    if rows * states.itemsize * states.shape[1] > STATES_BYTES:
        states = states[::2]
        run["stored"] = len(states)
        stride = 2 * stride
        rows = rows // 2
    return np.resize(states, (rows, states.shape[1])), stride


def _columns(record: NDArray[np.void]) -> tuple[NDArray[np.void], FloatArray]:
    """Transitions, and the intervals before them [s]."""
    transitions = np.empty(len(record), dtype=TRANSITION)
    for name in TRANSITION.names or ():
        transitions[name] = record[name]
    return transitions, record["interval"].copy()
