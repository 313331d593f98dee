"""Simulate a chain exactly: every transition between stick and slip, to rounding."""

from __future__ import annotations

from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from precursors import kernel
from precursors.chain import Chain, FloatArray, positive, whole
from precursors.run import TRANSITION, Run, States

IntArray = NDArray[np.int64]

MAX_TRANSITIONS = 10_000_000
# Stored states are thinned out so that they never take more room than this.
STATES_BYTES = 64 * 2**20
# A state is stored after so many transitions that storing takes little time beside finding them.
BLOCKS_PER_STRIDE = 16
# The kernel returns after so many windows, so that Ctrl-C is heard within about a second.
WINDOWS_PER_CALL = 500_000
FIRST_ROOM = 2048


class TransitionLimitError(RuntimeError):
    """A run met its cap on transitions; `run` holds what was computed up to there."""

    def __init__(self, message: str, run: Run) -> None:
        super().__init__(message)
        self.run = run


def simulate(
    chain: Chain,
    duration: float = 10.0,
    until: Literal["global slip"] | None = None,
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
        If the cap is met; its attribute `run` holds what was computed.
    """
    duration = positive("duration", duration, "s")
    if until not in (None, "global slip"):
        raise ValueError(f'until = {until!r} is unknown: allowed is None or "global slip"')
    max_transitions = whole("max_transitions", max_transitions, at_least=1)
    positions = _start("start_positions", start_positions, "m", chain)
    velocities = _start("start_velocities", start_velocities, "m/s", chain)

    system = kernel.scale(chain)
    velocity, force, start_mode = kernel.start_state(system, chain, positions, velocities)
    mode = np.zeros_like(start_mode)
    clock, count = np.zeros(4), np.zeros(4, np.int64)
    record = _Record(velocity, force, mode)
    mode[:] = start_mode
    moving = np.flatnonzero(mode)
    record.make_room(0, count, max(max_transitions, len(moving)))
    record.start(moving, mode, force[1])
    count[:] = len(moving), len(moving), len(moving) == chain.n_blocks, 1

    status = kernel.PAUSED
    while True:
        status = kernel.run_events(
            *system,
            velocity,
            force,
            mode,
            clock,
            count,
            duration,
            until is not None,
            *record.columns,
            record.intervals,
            record.states,
            record.stride,
            WINDOWS_PER_CALL,
        )
        n = int(count[kernel.TRANSITIONS])
        if status != kernel.PAUSED or n >= max_transitions:
            break
        record.make_room(n, count, max_transitions)
    elapsed = clock[kernel.ONSET] + (clock[kernel.ONSET_ERROR] + clock[kernel.ELAPSED] * system.tau)
    run = Run(
        chain=chain,
        duration=duration if status == kernel.FINISHED else float(elapsed),
        start_positions=positions,
        start_velocities=velocities,
        **record.finished(n, int(count[kernel.STORED]), clock[kernel.SINCE] * system.tau),
    )
    if status == kernel.PAUSED:
        raise TransitionLimitError(
            f"max_transitions = {max_transitions} reached at t = {elapsed:.9g} s of {duration:g} s, "
            f"last at block {run.transitions['block'][-1]}: raise max_transitions or shorten duration",
            run,
        )
    return run


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
    return start


class _Record:
    """Room for the transitions and states of a run, grown as needed."""

    def __init__(self, velocity: FloatArray, force: FloatArray, mode: IntArray) -> None:
        self.stride = 1 + len(mode) // BLOCKS_PER_STRIDE
        self.columns = (np.empty(0), np.empty(0, np.int64), np.empty(0, np.int64), np.empty(0))
        self.intervals = np.empty(0)
        start = (force, velocity, mode, np.int64(0), 0.0)
        self.states = tuple(np.array(value)[None] for value in start)

    def make_room(self, used: int, count: IntArray, most: int) -> None:
        """Enlarge what is full; thin the states out where they take too much."""
        if used == len(self.intervals):
            room = min(max(FIRST_ROOM, 2 * used), most)
            time, block, mode, load = self.columns
            self.columns = (
                _enlarged(time, room),
                _enlarged(block, room),
                _enlarged(mode, room),
                _enlarged(load, room),
            )
            self.intervals = _enlarged(self.intervals, room)
        stored = count[kernel.STORED]
        if stored < len(self.states[0]) > 1:
            return
        rows = max(FIRST_ROOM // self.stride, 2 * len(self.states[0]))
        if rows * sum(s[0].nbytes for s in self.states) > STATES_BYTES and stored > 1:
            self.states = tuple(s[:stored:2] for s in self.states)
            self.stride *= 2
            count[kernel.STORED] = len(self.states[0])
        self.states = tuple(_enlarged(s, rows) for s in self.states)

    def start(self, moving: IntArray, mode: IntArray, tangential_load: float) -> None:
        """Note the blocks that move at time 0 as transitions."""
        n = len(moving)
        values: tuple[Any, ...] = (0.0, moving, mode[moving], tangential_load)
        for column, value in zip(self.columns, values, strict=True):
            column[:n] = value
        self.intervals[:n] = 0.0

    def finished(self, n: int, stored: int, last_interval: float) -> dict[str, Any]:
        """Cut what was recorded to n transitions, as arguments of `Run`."""
        transitions = np.empty(n, dtype=TRANSITION)
        for name, column in zip(TRANSITION.names or (), self.columns, strict=True):
            transitions[name] = column[:n]
        return {
            "transitions": transitions,
            "intervals": np.append(self.intervals[:n], last_interval),
            "states": States(*(s[:stored].copy() for s in self.states)),
        }


def _enlarged(values: NDArray, rows: int) -> NDArray:
    larger = np.zeros((rows, *values.shape[1:]), values.dtype)
    larger[: len(values)] = values
    return larger
