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
# The kernel returns after so many windows, so that Ctrl-C is heard within about a second.
WINDOWS_PER_CALL = 500_000
FIRST_ROOM = 4096


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
    force, velocity, start_mode = kernel.start_state(system, chain, positions, velocities)
    mode = np.zeros_like(start_mode)
    clock, count = np.zeros(4), np.zeros(3, np.int64)
    record = _Record(force, velocity, mode)
    moving = np.flatnonzero(start_mode)
    record.make_room(len(moving), max_transitions)
    for k, block in enumerate(moving):
        mode[block] = start_mode[block]
        record.start(k, int(block), force, velocity, mode)
    count[:] = len(moving), len(moving), len(moving) == chain.n_blocks

    status = kernel.PAUSED
    while status == kernel.PAUSED and count[kernel.TRANSITIONS] < max_transitions:
        record.make_room(int(count[kernel.TRANSITIONS]), max_transitions)
        status = kernel.run_events(
            system,
            force,
            velocity,
            mode,
            clock,
            count,
            duration,
            until is not None,
            record.columns,
            record.intervals,
            record.states,
            record.stride,
            WINDOWS_PER_CALL,
        )
    n = int(count[kernel.TRANSITIONS])
    elapsed = clock[kernel.ONSET] + (clock[kernel.ONSET_ERROR] + clock[kernel.ELAPSED] * system.tau)
    run = Run(
        chain=chain,
        duration=duration if status == kernel.FINISHED else float(elapsed),
        start_positions=positions,
        start_velocities=velocities,
        **record.finished(n, clock[kernel.SINCE] * system.tau),
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

    def __init__(self, force: FloatArray, velocity: FloatArray, mode: IntArray) -> None:
        self.stride = 1
        self.columns = (np.empty(0), np.empty(0, np.int64), np.empty(0, np.int64), np.empty(0))
        self.intervals = np.empty(0)
        self.states = (force[None].copy(), velocity[None].copy(), mode[None].copy())

    def make_room(self, used: int, most: int) -> None:
        """Double the room for transitions where it is full; thin the states out where they take too much."""
        room = len(self.intervals)
        if used < room:
            return
        room = min(max(FIRST_ROOM, 2 * used), max(most, used))
        self.columns = tuple(_enlarged(column, room) for column in self.columns)
        self.intervals = _enlarged(self.intervals, room)
        while sum(s[0].nbytes for s in self.states) * (room // self.stride + 1) > STATES_BYTES:
            self.states = tuple(s[::2] for s in self.states)
            self.stride *= 2
        self.states = tuple(_enlarged(s, room // self.stride + 1) for s in self.states)

    def start(self, k: int, block: int, force: FloatArray, velocity: FloatArray, mode: IntArray) -> None:
        """Note a block that moves at time 0 as transition k; the state is the one after it."""
        for column, value in zip(self.columns, (0.0, block, mode[block], force[1]), strict=True):
            column[k] = value
        self.intervals[k] = 0.0
        if (k + 1) % self.stride == 0:
            for store, value in zip(self.states, (force, velocity, mode), strict=True):
                store[(k + 1) // self.stride] = value

    def finished(self, n: int, last_interval: float) -> dict[str, Any]:
        """Cut what was recorded to n transitions, as arguments of `Run`."""
        transitions = np.empty(n, dtype=TRANSITION)
        for name, column in zip(TRANSITION.names or (), self.columns, strict=True):
            transitions[name] = column[:n]
        return {
            "transitions": transitions,
            "intervals": np.append(self.intervals[:n], last_interval),
            "states": States(*(s[: n // self.stride + 1].copy() for s in self.states), self.stride),
        }


def _enlarged(values: NDArray, rows: int) -> NDArray:
    larger = np.zeros((rows, *values.shape[1:]), values.dtype)
    larger[: len(values)] = values
    return larger
