"""Chains of equal length through the compiled kernel, and what it recorded as runs."""

import threading
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from precursors.model.chain import Chain, FloatArray
from precursors.solver import kernel
from precursors.solver.record import COLUMNS, TRANSITION, States
from precursors.solver.run import Record, Run
from precursors.support.waiting import bar

# Stored states are thinned out so that they never take more room than this.
STATES_BYTES = 64 * 2**20
# The kernel returns after so many windows, so that Ctrl-C is heard within about a
# second.
WINDOWS_PER_CALL = 500_000
# Transitions that a thread's record has room for.
SHARED_ROOM = 8192


class TransitionLimitError(RuntimeError):
    """A run met its cap on transitions or on work; `run` holds what was computed up to
    there."""

    def __init__(self, message: str, run: Record) -> None:
        super().__init__(message)
        self.run = run


class _Recorder:
    """What the kernel writes of chains of one length: rows of transitions, and states
    every `stride` transitions, of finished runs and then of the one that goes on."""

    def __init__(self, n_blocks: int) -> None:
        self.n_blocks = n_blocks
        # Storing takes little time beside finding so many transitions.
        self.stride = max(10, 1 + n_blocks // 3)
        self.memory = kernel.memory_for(n_blocks)
        n_states = max(SHARED_ROOM // self.stride, 2)
        self.empty = (
            np.zeros((max(SHARED_ROOM, 2 * n_blocks), kernel.ROW)),
            np.empty((n_states, 2 + 3 * n_blocks)),
        )

    def room(self, progress: NDArray[np.void], j: int) -> tuple[FloatArray, FloatArray]:
        """Record and states for run j to begin in, or to go on in, longer where they
        are full."""
        # Of a record, a field of the array is read faster than one of its row.
        if progress["stored"][j] == 0:  # it has not begun
            self.record, self.states = self.empty
            return self.empty
        run = progress[j]
        if run["transitions"] + 1 == len(self.record):
            self.record = np.resize(self.record, (2 * len(self.record), kernel.ROW))
        if run["stored"] == len(self.states):
            self.states = _with_room(self.states, run)
        return self.record, self.states

    def take(self, rows: int, states: int) -> tuple[FloatArray, FloatArray]:
        """Record and states of the finished runs, which have so many rows."""
        finished = self.record[:rows], self.states[:states]
        self.record = self.record[rows:]
        self.states = self.states[states:]
        return finished


_own = threading.local()


def _recorder_for(n_blocks: int) -> _Recorder:
    """The recorder of this thread, kept from call to call."""
    recorder: _Recorder | None = vars(_own).get("recorder")
    if recorder is None or recorder.n_blocks != n_blocks:
        recorder = _own.recorder = _Recorder(n_blocks)
    return recorder


def run_batch(
    chains: Sequence[Chain],
    positions: FloatArray,
    velocities: FloatArray,
    end: kernel.End,
) -> Iterator[Run]:
    """Run chains of equal length one after the other, in as few calls of the kernel as
    it takes.

    A thread has one recorder: it must take all runs before it begins others.
    """
    recorder = _recorder_for(chains[0].n_blocks)
    batch = kernel.Batch(
        parameters=np.array([kernel.parameters(chain) for chain in chains]),
        weights=np.array([chain.weights for chain in chains]),
        positions=positions,
        velocities=velocities,
    )
    words = np.zeros((len(chains), kernel.WORDS), np.int64)
    progress = words.view(kernel.PROGRESS)[:, 0]
    progress["stride"] = recorder.stride
    first = 0
    told: Any = None  # it takes a quarter of a short run's time
    try:
        while True:
            arrays = (words, *recorder.room(progress, first), recorder.memory)
            n_finished, *rows = kernel.run_batch(
                batch, end, *arrays, first, WINDOWS_PER_CALL
            )
            which = range(first, n_finished)
            yield from _runs(chains, batch, progress, which, *recorder.take(*rows), end)
            first = n_finished
            if first == len(chains):
                return
            if told is None:
                told = bar("running", end.duration)
            told.update(progress["onset"].mean() - told.n)
    finally:
        if told is not None:
            told.close()


def _runs(
    chains: Sequence[Chain],
    batch: kernel.Batch,
    progress: NDArray[np.void],
    which: range,
    record: FloatArray,
    states: FloatArray,
    end: kernel.End,
) -> Iterator[Run]:
    """Runs of a batch that were recorded one after the other; an error if one met a
    cap."""
    transitions = np.empty(len(record), TRANSITION)
    for name, column in zip(COLUMNS, record.T, strict=False):
        transitions[name] = column
    intervals = record[:, -1].copy()
    stored = States.from_rows(states)
    row = state = 0
    for j in which:
        end_row = row + progress["transitions"][j]
        end_state = state + progress["stored"][j]
        status = progress["status"][j]
        is_finished = status == kernel.FINISHED
        run = Run(
            chain=chains[j],
            duration=end.duration if is_finished else float(record[end_row, 0]),
            transitions=transitions[row:end_row],
            intervals=intervals[row : end_row + 1],
            start_positions=batch.positions[j],
            start_velocities=batch.velocities[j],
            states=States._make([column[state:end_state] for column in stored]),
            evaluations=float(progress["derivatives"][j]) / chains[j].n_blocks,
        )
        if status == kernel.PAUSED:
            raise _unfinished(run, end)
        yield run
        row = end_row + 1
        state = end_state


def _unfinished(run: Run, end: kernel.End) -> TransitionLimitError:
    """The error of a run that met a cap before its end."""
    where = f"at t = {run.duration:.9g} s of {end.duration:g} s"
    if len(run.transitions) >= end.most:
        return TransitionLimitError(
            f"max_transitions = {end.most} reached {where}, last at block {run.transitions['block'][-1]}: "
            "raise max_transitions or shorten duration",
            run,
        )
    return TransitionLimitError(
        f"{end.most_windows:g} steps made {where}, as blocks slide nearly all the time: shorten duration",
        run,
    )


def _with_room(states: FloatArray, run: np.void) -> FloatArray:
    """Stored states of a run, made longer.

    Every second one is dropped where they would take more than `STATES_BYTES`.
    """
    rows = 2 * len(states)
    if 2 * states.nbytes > STATES_BYTES:
        states = states[::2]
        run["stored"] = len(states)
        run["stride"] *= 2
        rows = rows // 2
    return np.resize(states, (rows, states.shape[1]))
