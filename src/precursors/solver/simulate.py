"""Simulate chains exactly: every transition between stick and slip, to rounding."""

from __future__ import annotations

import os
import threading
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from precursors.model.chain import LARGEST, Chain, FloatArray, Until, checked_span, whole
from precursors.solver import kernel
from precursors.solver.run import TRANSITION, Run, States

IntArray = NDArray[np.int64]

MAX_TRANSITIONS = 10_000_000
# Stored states are thinned out so that they never take more room than this.
STATES_BYTES = 64 * 2**20
# A state is stored after so many transitions that storing takes little time beside finding them.
BLOCKS_PER_STRIDE = 16
# The kernel returns after so many windows, so that Ctrl-C is heard within about a second.
WINDOWS_PER_CALL = 500_000
# Blocks that slide without end would keep the kernel busy for ever: some 10 minutes at N = 10.
MAX_WINDOWS = 1_000_000_000
# Transitions that a run may have before it gets a record of its own, and that a thread's record has room for.
FIRST_ROOM, SHARED_ROOM = 2048, 16384
# Chains of a batch: many for little work between batches, few for all threads to end together.
LARGEST_BATCH, BATCHES_PER_THREAD = 64, 8


class TransitionLimitError(RuntimeError):
    """A run met its cap on transitions or on work; `run` holds what was computed up to there."""

    def __init__(self, message: str, run: Run) -> None:
        super().__init__(message)
        self.run = run


def simulate(
    chain: Chain,
    duration: float = 10.0,
    until: Until = None,
    start_positions: ArrayLike | None = None,
    start_velocities: ArrayLike | None = None,
    max_transitions: int = MAX_TRANSITIONS,
) -> Run:
    """Run a chain from rest, or from a given start, through all its transitions (Eqs. 2-6).

    Parameters
    ----------
    chain : Chain
        The chain.
    duration : float
        Time to run [s]; with `until`, the limit.
    until : "global slip", optional
        Stop at the end of the first event in which all blocks slide at the same instant.
    start_positions, start_velocities : array_like, shape (N,), optional
        Positions [m] relative to springs at natural length, and velocities [m/s], at time 0; zero by default.
    max_transitions : int
        Cap on the number of transitions.

    Returns
    -------
    Run
        The transitions and the states between them.

    Raises
    ------
    ValueError
        If an argument is out of range.
    TransitionLimitError
        If the cap, or one on the work of chains that hardly ever rest, is met; its attribute `run` holds what
        was computed.
    """
    duration, max_transitions = _limits(duration, until, max_transitions)
    positions = _start("start_positions", start_positions, "m", chain)
    velocities = _start("start_velocities", start_velocities, "m/s", chain)
    return _run_batch([chain], positions[None], velocities[None], duration, until, max_transitions)[0]


def simulate_many(
    chains: Sequence[Chain],
    duration: float = 10.0,
    until: Until = None,
    threads: int | None = None,
    start_positions: Sequence[ArrayLike] | None = None,
    start_velocities: Sequence[ArrayLike] | None = None,
    progress: Callable[[int], object] | None = None,
) -> list[Run]:
    """Run an ensemble on all cores; every run is what `simulate` makes of its chain, bit for bit.

    Parameters
    ----------
    chains : sequence of Chain
        The chains, of any lengths.
    duration, until
        As in `simulate`, for all of them.
    threads : int, optional
        Threads to use; by default as many as there are cores for this process.
    start_positions, start_velocities : sequence of array_like, optional
        One start for each chain, as in `simulate`.
    progress : callable, optional
        Called from the calling thread with the number of runs that are done, now and then and at the end.

    Returns
    -------
    list of Run
        In the order of `chains`.

    Raises
    ------
    ValueError
        If an argument is out of range.
    TransitionLimitError
        If a run meets the cap of `simulate`.
    """
    duration, max_transitions = _limits(duration, until, MAX_TRANSITIONS)
    threads = available_cores() if threads is None else whole("threads", threads, at_least=1)
    positions = _starts("start_positions", start_positions, "m", chains)
    velocities = _starts("start_velocities", start_velocities, "m/s", chains)

    def run(batch: list[int]) -> list[Run]:
        start = np.array([positions[j] for j in batch]), np.array([velocities[j] for j in batch])
        return _run_batch([chains[j] for j in batch], *start, duration, until, max_transitions)

    runs: dict[int, Run] = {}
    with ThreadPoolExecutor(threads, "simulate") as pool:
        futures = {pool.submit(run, batch): batch for batch in _batches(chains, threads)}
        try:
            for future in as_completed(futures):
                runs.update(zip(futures[future], future.result(), strict=True))
                if progress is not None:
                    progress(len(runs))
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            raise
    return [runs[j] for j in range(len(chains))]


def _limits(duration: float, until: Until, max_transitions: int) -> tuple[float, int]:
    return checked_span(duration, until), whole("max_transitions", max_transitions, at_least=1)


def _start(name: str, values: ArrayLike | None, unit: str, chain: Chain) -> FloatArray:
    if values is None:
        return np.zeros(chain.n_blocks)
    try:
        start = np.array(values, dtype=np.float64)
    except (TypeError, ValueError):
        raise ValueError(f"{name} = {values!r} [{unit}] are not numbers") from None
    if start.shape != (chain.n_blocks,):
        raise ValueError(
            f"{name} have shape {start.shape}: allowed is ({chain.n_blocks},), one [{unit}] a block"
        )
    if not np.isfinite(start).all():
        raise ValueError(f"{name} hold a value that is not finite: allowed are finite numbers [{unit}]")
    if np.abs(start).max() > LARGEST:
        raise ValueError(f"{name} hold a value beyond {LARGEST:g} {unit}, which cannot be computed with")
    return start


def _starts(
    name: str, values: Sequence[ArrayLike] | None, unit: str, chains: Sequence[Chain]
) -> list[FloatArray]:
    if values is None:
        return [np.zeros(chain.n_blocks) for chain in chains]
    if len(values) != len(chains):
        raise ValueError(f"{name} are {len(values)}: allowed is one for each of the {len(chains)} chains")
    return [
        _start(f"{name}[{j}]", value, unit, chain)
        for j, (value, chain) in enumerate(zip(values, chains, strict=True))
    ]


def available_cores() -> int:
    """Number of cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def _batches(chains: Sequence[Chain], threads: int) -> Iterator[list[int]]:
    """Numbers of chains of equal length and kind, so many at a time as one call of the kernel takes."""
    most = min(LARGEST_BATCH, max(1, len(chains) // (threads * BATCHES_PER_THREAD)))
    alike: dict[tuple[int, bool], list[int]] = {}
    for j, chain in enumerate(chains):
        alike.setdefault((chain.n_blocks, kernel.is_linked(chain)), []).append(j)
    for _, members in sorted(alike.items(), reverse=True):
        for first in range(0, len(members), most):
            yield members[first : first + most]


class _Workspace(threading.local):
    """The record into which a thread runs chains of one length and kind, kept from call to call."""

    kind: tuple[int, bool, bool] | None = None

    def prepare(self, n_blocks: int, is_linked: bool, on_springs: bool) -> None:
        """Make room for chains of `n_blocks`, if it is not there yet."""
        if (n_blocks, is_linked, on_springs) == self.kind:
            return
        wide = kernel.width(n_blocks)
        self.stride = 1 + wide // BLOCKS_PER_STRIDE
        self.state_room = max(FIRST_ROOM // self.stride, 2)
        self.additions = kernel.new_additions(n_blocks) if is_linked else None
        self.ringing = kernel.new_ringing(n_blocks, on_springs) if is_linked else None
        rows = max(SHARED_ROOM // self.stride, 2)
        self.room = kernel.Room(
            kernel.new_columns(n_blocks),
            kernel.new_state(n_blocks),
            kernel.new_motion(n_blocks),
            kernel.new_search(n_blocks),
            kernel.Record._make(np.empty(max(SHARED_ROOM, 2 * n_blocks), kind) for kind in RECORD),
            kernel.States(
                np.empty((rows, wide)),
                np.empty((rows, wide)),
                np.empty((rows, wide), np.int64),
                np.empty(rows, np.int64),
                np.empty(rows),
                np.zeros((rows, wide if is_linked else 0)),
            ),
        )
        self.arrays = self.room.arrays
        self.kind = n_blocks, is_linked, on_springs


_workspace = _Workspace()


def _run_batch(
    chains: Sequence[Chain],
    positions: FloatArray,
    velocities: FloatArray,
    duration: float,
    until: Until,
    max_transitions: int,
) -> list[Run]:
    """Run chains of equal length one after the other, in as few calls of the kernel as it takes."""
    work = _workspace
    on_springs = any(chain.interface_stiffness > 0.0 for chain in chains)
    work.prepare(chains[0].n_blocks, kernel.is_linked(chains[0]), on_springs)
    parameters = np.array([kernel.parameters(chain) for chain in chains])
    weights = np.array([chain.weights for chain in chains])
    taus = np.empty(len(chains))
    clocks = np.zeros((len(chains), kernel.CLOCK_SIZE))
    counts = np.zeros((len(chains), kernel.COUNT_SIZE), np.int64)
    ends = taus, clocks, counts
    runs: list[Run] = []
    ends_at = duration, until is not None
    most = min(FIRST_ROOM, max_transitions), work.state_room, WINDOWS_PER_CALL
    while len(runs) < len(chains):
        left = slice(len(runs), None)
        n_finished, is_paused = kernel.run_batch(
            parameters[left],
            weights[left],
            positions[left],
            velocities[left],
            *ends_at,
            *most,
            False,
            work.stride,
            work.additions,
            work.ringing,
            taus[left],
            clocks[left],
            counts[left],
            *work.arrays,
        )
        for j, part in zip(
            range(len(runs), len(runs) + n_finished + is_paused),
            _parts(work, counts[left][: n_finished + is_paused]),
            strict=True,
        ):
            if counts[j, kernel.STATUS] == kernel.PAUSED:
                mine = slice(j, j + 1)
                chain = parameters[mine], weights[mine], positions[mine], velocities[mine], *ends_at
                part = _go_on(chain, part, work, [values[mine] for values in ends], max_transitions)
            elapsed = clocks[j, kernel.ONSET] + (
                clocks[j, kernel.ONSET_ERROR] + clocks[j, kernel.ELAPSED] * taus[j]
            )
            transitions = part.transitions
            run = Run(
                chain=chains[j],
                duration=duration if counts[j, kernel.STATUS] == kernel.FINISHED else float(elapsed),
                transitions=transitions,
                intervals=part.intervals,
                start_positions=positions[j],
                start_velocities=velocities[j],
                states=_needed(part.states, chains[j]),
                evaluations=float(counts[j, kernel.DERIVATIVES]) / chains[j].n_blocks,
            )
            if counts[j, kernel.STATUS] == kernel.PAUSED:
                where = f"at t = {elapsed:.9g} s of {duration:g} s"
                if len(transitions) >= max_transitions:
                    raise TransitionLimitError(
                        f"max_transitions = {max_transitions} reached {where}, last at block "
                        f"{transitions['block'][-1]}: raise max_transitions or shorten duration",
                        run,
                    )
                raise TransitionLimitError(
                    f"{MAX_WINDOWS:g} steps of the motion made {where}, blocks slide nearly all the time: "
                    "shorten duration",
                    run,
                )
            runs.append(run)
    return runs


class _Part(NamedTuple):
    """What was recorded of one run."""

    transitions: NDArray[np.void]
    intervals: FloatArray
    states: States


def _parts(work: _Workspace, counts: IntArray) -> Iterator[_Part]:
    """Cut the record of several runs, as `counts` has them, into one part a run."""
    used, stored = counts[:, kernel.TRANSITIONS].tolist(), counts[:, kernel.STORED].tolist()
    transitions = _transitions(work.room.record[:-1], sum(used))
    intervals: FloatArray = work.room.record[-1][: sum(used) + len(used)].copy()
    n_states = sum(stored)
    states = [column[:n_states].copy() for column in work.room.states]
    if len(used) == 1:
        yield _Part(transitions, intervals, _states(states, slice(None)))
        return
    first = first_state = 0
    for j, (n, m) in enumerate(zip(used, stored, strict=True)):
        yield _Part(
            transitions[first : first + n],
            intervals[first + j : first + j + n + 1],
            _states(states, slice(first_state, first_state + m)),
        )
        first, first_state = first + n, first_state + m


def _go_on(
    chain: tuple[Any, ...],
    part: _Part,
    work: _Workspace,
    ends: Sequence[NDArray[Any]],
    max_transitions: int,
) -> _Part:
    """Run on a chain that the kernel left unfinished, in a record of its own."""
    [tau], [clock], [count] = ends
    record = _Record(part, work.stride)
    while (
        count[kernel.STATUS] == kernel.PAUSED
        and count[kernel.TRANSITIONS] < max_transitions
        and count[kernel.WINDOWS] < MAX_WINDOWS
    ):
        record.make_room(count, max_transitions)
        room = work.room._replace(record=record.columns, states=record.states)
        most = len(record.columns.time), len(record.states.after), WINDOWS_PER_CALL
        linked = work.additions, work.ringing
        kernel.run_batch(*chain, *most, True, record.stride, *linked, *ends, *room.arrays)
    return record.part(count, clock[kernel.SINCE] * tau)


class _Record:
    """Room for the transitions and states of a long run, grown as needed."""

    def __init__(self, part: _Part, stride: int) -> None:
        self.stride = stride
        values = [part.transitions[name] for name in TRANSITION.names or ()]
        self.columns = kernel.Record._make(
            column.astype(kind) for column, kind in zip([*values, part.intervals], RECORD, strict=True)
        )
        self.states = part.states

    def make_room(self, count: IntArray, most: int) -> None:
        """Enlarge what is full; thin the states out where they take too much."""
        used, stored = int(count[kernel.TRANSITIONS]), int(count[kernel.STORED])
        if used >= len(self.columns[0]) or len(self.columns[0]) < len(self.columns[-1]):
            room = min(max(FIRST_ROOM, 2 * used), most)
            self.columns = kernel.Record._make(_enlarged(column[:used], room) for column in self.columns)
        if stored < len(self.states[0]):
            return
        rows = max(FIRST_ROOM // self.stride, 2 * len(self.states[0]))
        if rows * sum(s[0].nbytes for s in self.states) > STATES_BYTES and stored > 1:
            self.states = kernel.States._make(np.ascontiguousarray(s[:stored:2]) for s in self.states)
            self.stride *= 2
            count[kernel.STORED] = len(self.states[0])
        self.states = kernel.States._make(_enlarged(s, rows) for s in self.states)

    def part(self, count: IntArray, last_interval: float) -> _Part:
        """What was recorded, the time since the last transition as its last interval."""
        n, stored = int(count[kernel.TRANSITIONS]), int(count[kernel.STORED])
        return _Part(
            _transitions(self.columns[:-1], n),
            np.append(self.columns[-1][:n], last_interval),
            _states([column[:stored].copy() for column in self.states], slice(None)),
        )


# Types of a record's columns: time, block, mode, tangential load, interval.
RECORD: tuple[Any, ...] = (np.float64, np.int64, np.int64, np.float64, np.float64)


def _states(columns: Sequence[NDArray[Any]], rows: slice) -> States:
    return States(*(column[rows] for column in columns))


def _needed(states: States, chain: Chain) -> States:
    """The states without the forces of interface springs where there are none."""
    if chain.interface_stiffness or not states.grip.size:
        return states
    return states._replace(grip=np.empty((len(states.after), 0)))


def _transitions(columns: Sequence[NDArray], n: int) -> NDArray[np.void]:
    transitions = np.empty(n, dtype=TRANSITION)
    for name, column in zip(TRANSITION.names or (), columns, strict=True):
        transitions[name] = column[:n]
    return transitions


def _enlarged(values: NDArray[Any], rows: int) -> NDArray[Any]:
    larger = np.empty((rows, *values.shape[1:]), values.dtype)
    larger[: len(values)] = values
    return larger
