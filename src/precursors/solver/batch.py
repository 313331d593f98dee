"""Run chains of equally many blocks in the kernel, and turn its records into runs."""

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

# Stored states are thinned so that they take no more memory than this.
STATES_BYTES = 64 * 2**20
# The kernel returns after this many windows (steps of time), so that Ctrl-C takes
# effect within about a second.
WINDOWS_PER_CALL = 500_000
# Capacity of a thread's record, in transitions.
SHARED_ROOM = 8192


class TransitionLimitError(RuntimeError):
    """A run met its limit of transitions or of work; `run` is its motion up to
    there."""

    def __init__(self, message: str, run: Record) -> None:
        super().__init__(message)
        self.run = run


class _Room(threading.local):
    """Arrays of a thread, into which the kernel writes in call after call.

    They hold rows of transitions, and states every `stride` transitions, of chains with
    the same number of blocks.
    """

    n_blocks = 0

    def fit(self, n_blocks: int) -> None:
        """Allocate the arrays again if the number of blocks has changed."""
        if n_blocks == self.n_blocks:
            return
        # With this stride, storing takes little time compared with the transitions.
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
    """Run chains of equally many blocks one after the other, in as few calls of the
    kernel as possible.

    All calls in a thread share its arrays: exhaust one iterator before starting
    another.
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
    display: Any = None  # made late, as it takes a quarter of a short run's time
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
            if progress["stored"][first] == 0:  # not started yet
                record = _room.record
                states = _room.states
            else:
                record = _longer_record(record[rows:], progress[first])
                states = _longer_states(states[stored:], progress[first])
            if display is None:
                display = bar("running", end.duration)
            display.update(progress["onset"].mean() - display.n)
    finally:
        if display is not None:
            display.close()


def _runs(
    chains: Sequence[Chain],
    batch: kernel.Batch,
    progress: NDArray[np.void],
    which: range,
    record: FloatArray,
    states: FloatArray,
    end: kernel.End,
) -> Iterator[Run]:
    """Yield the runs of a batch, which were recorded one after the other.

    Raises
    ------
    TransitionLimitError
        If a run met a limit.
    """
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
        if kernel.should_compile_evaluation():
            run.at(0.0)
        yield run
        row = end_row + 1
        state = end_state


def _unfinished(run: Run, end: kernel.End) -> TransitionLimitError:
    """Return the error of a run that met a limit before its end."""
    where = f"at t = {run.duration:.9g} s of {end.duration:g} s"
    if len(run.transitions) >= end.most:
        return TransitionLimitError(
            f"max_transitions = {end.most} reached {where}, last at block {run.transitions['block'][-1]}: "
            "raise max_transitions or shorten duration",
            run,
        )
    return TransitionLimitError(
        f"{end.most_windows:g} steps made {where}, and blocks slide nearly all the time: shorten duration",
        run,
    )


def _longer_record(record: FloatArray, run: np.void) -> FloatArray:
    """Return the record of a run, doubled if it is full."""
    is_full = run["transitions"] + 1 == len(record)
    return np.resize(record, (2 * len(record), kernel.ROW)) if is_full else record


def _longer_states(states: FloatArray, run: np.void) -> FloatArray:
    """Return the stored states of a run, doubled if they are full.

    If they would take more than `STATES_BYTES`, every second state is dropped.
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
