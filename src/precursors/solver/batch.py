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


class _Room(threading.local):
    """Room of a thread, kept from call to call, for what the kernel writes of chains of
    one length: rows of transitions, and states every `stride` transitions."""

    n_blocks = 0

    def fit(self, n_blocks: int) -> None:
        """Make it anew for chains of another length."""
        if n_blocks == self.n_blocks:
            return
        # Storing takes little time beside finding so many transitions.
        self.stride = max(10, 1 + n_blocks // 3)
        self.memory = kernel.memory_for(n_blocks)
        self.record = np.zeros((max(SHARED_ROOM, 2 * n_blocks), kernel.ROW))
        n_states = max(SHARED_ROOM // self.stride, 2)
        self.states = np.empty((n_states, 2 + 3 * n_blocks))
        self.n_blocks = n_blocks


_room = _Room()


def run_batch(
    chains: Sequence[Chain],
    positions: FloatArray,
    velocities: FloatArray,
    end: kernel.End,
) -> Iterator[Run]:
    """Run chains of equal length one after the other, in as few calls of the kernel as
    it takes.

    A thread has one room: it must take all runs before it begins others.
    """
    _room.fit(chains[0].n_blocks)
    batch = kernel.Batch(
        parameters=np.array([kernel.parameters(chain) for chain in chains]),
        weights=np.array([chain.weights for chain in chains]),
        positions=positions,
        velocities=velocities,
    )
    progress = np.zeros(len(chains), kernel.PROGRESS)
    progress["stride"] = _room.stride
    record = _room.record
    states = _room.states
    first = 0
    told: Any = None  # it takes a quarter of a short run's time
    try:
        while True:
            arrays = (progress, record, states, _room.memory)
            n_finished, rows, stored = kernel.run_batch(
                batch, end, *arrays, first, WINDOWS_PER_CALL
            )
            finished = (range(first, n_finished), record[:rows], states[:stored])
            yield from _runs(chains, batch, progress, *finished, end)
            first = n_finished
            if first == len(chains):
                return
            if progress["stored"][first] == 0:  # it has not begun
                record = _room.record
                states = _room.states
            else:
                record = _longer_record(record[rows:], progress[first])
                states = _longer_states(states[stored:], progress[first])
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
        if kernel.is_compiled_now():
            run.at(0.0)
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


def _longer_record(record: FloatArray, run: np.void) -> FloatArray:
    """The record of a run, longer if it is full."""
    is_full = run["transitions"] + 1 == len(record)
    return np.resize(record, (2 * len(record), kernel.ROW)) if is_full else record


def _longer_states(states: FloatArray, run: np.void) -> FloatArray:
    """Stored states of a run, longer if they are full.

    Every second one is dropped where they would take more than `STATES_BYTES`.
    """
    rows = len(states)
    if run["stored"] < rows:
        return states
    if 2 * states.nbytes > STATES_BYTES:
        states = states[::2]
        run["stored"] = len(states)
        run["stride"] *= 2
    else:
        rows *= 2
    return np.resize(states, (rows, states.shape[1]))
