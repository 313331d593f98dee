"""A record has the transitions of a chain; a run also has its exact states."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from precursors.model.chain import Chain, FloatArray
from precursors.model.checks import number_array
from precursors.solver.record import COLUMNS, TRANSITION, States
from precursors.solver.run_file import RunFileError, read_record, write_record
from precursors.support.files import AnyPath


@dataclass(frozen=True, eq=False)
class Record:
    """Transitions of a chain from time 0 to `duration`, by any method.

    Attributes
    ----------
    chain : Chain
        The chain that moved.
    duration : float
        Time reached [s].
    transitions : structured array
        time [s], block (1..N), mode (+1 slides forward, 0 sticks, -1 slides backward),
        tangential_load [N].
    intervals : array, shape (n_transitions + 1,)
        Times [s] from the start to the first transition, between transitions, and from
        the last one to the end. They are more accurate than differences of `time`.
    """

    chain: Chain
    duration: float
    transitions: NDArray[np.void]
    intervals: FloatArray

    def __repr__(self) -> str:
        return (
            f"{type(self).__name__} of {self.duration:g} s with "
            f"{len(self.transitions)} transitions\n{self.chain!r}"
        )

    @classmethod
    def from_columns(
        cls,
        chain: Chain,
        duration: float,
        time: ArrayLike,
        block: ArrayLike,
        mode: ArrayLike,
        tangential_load: ArrayLike,
        intervals: ArrayLike | None = None,
        **others: Any,
    ) -> Self:
        """Make a record from columns of its transitions.

        By default, `intervals` are differences of `time`, whose rounding errors grow
        with time. `others` are further attributes of the class.
        """
        transitions = np.empty(np.size(time), dtype=TRANSITION)
        columns = (time, block, mode, tangential_load)
        for name, column in zip(COLUMNS, columns, strict=True):
            values = np.asarray(column)
            with np.errstate(invalid="ignore"):
                transitions[name] = values
            is_other = transitions[name] != values
            if name in ("block", "mode") and is_other.any():
                raise ValueError(
                    f"{name} must be of type {transitions.dtype[name]}, but one is {values[is_other][0]}"
                )
        if intervals is None:
            instants = np.concatenate([[0.0], transitions["time"], [duration]])
            intervals = np.diff(instants)
        return cls(
            chain=chain,
            duration=float(duration),
            transitions=transitions,
            intervals=np.array(intervals, dtype=np.float64),
            **others,
        )

    def save(self, path: AnyPath) -> None:
        """Write an HDF5 file completely or not at all; a missing directory is made."""
        write_record(self, path)

    @classmethod
    def load(cls, path: AnyPath) -> Self:
        """Read a file that `save` wrote.

        `Record.load` reads records and runs; `Run.load` refuses a record without
        states.

        Raises
        ------
        RunFileError
            If it is another kind of file, or damaged.
        """
        content = read_record(path)
        kind: type[Record] = Run if "states" in content else Record
        if not issubclass(kind, cls):
            raise RunFileError(
                f"{path} holds a {kind.__name__} and not a {cls.__name__}: "
                "Record.load reads it"
            )
        return kind.from_columns(**content)


@dataclass(frozen=True, eq=False, repr=False)
class Run(Record):
    """The motion of a chain from time 0 to `duration`, known exactly at every time.

    It has the attributes of a `Record`, and these:

    Attributes
    ----------
    start_positions, start_velocities : array, shape (N,)
        State at time 0 [m], [m/s].
    states : States
        Stored states, from which `at` computes all others.
    evaluations : float
        How many times the solver computed the forces on all blocks; each term of a
        Taylor series counts as one time.
    """

    start_positions: FloatArray
    start_velocities: FloatArray
    states: States
    evaluations: float

    def at(self, times: ArrayLike) -> tuple[FloatArray, FloatArray]:
        """Return positions [m] and velocities [m/s], each of shape (len(times), N),
        exact to rounding."""
        when = self._times(times)
        force, velocity = self.forces_and_velocities(when)
        # x_1 = V t - T_1/K (Eq. 3), x_2 = x_1 - T_2/k, ...
        behind = np.cumsum(force / self.chain.springs, axis=1)
        return self.chain.drive_velocity * when[:, None] - behind, velocity

    def tangential_load(self, times: ArrayLike) -> FloatArray:
        """Return the tangential load F_X = K(V t - x_1) [N], shape (len(times),) (Eq.
        3)."""
        return self.forces_and_velocities(times, 1)[0][:, 0]

    def spring_forces(self, times: ArrayLike) -> FloatArray:
        """Return the force in the spring behind each block [N], shape (len(times), N);
        column 0 is F_X."""
        return self.forces_and_velocities(times)[0]

    def forces_and_velocities(
        self, times: ArrayLike, n_blocks: int | None = None
    ) -> FloatArray:
        """Return spring forces [N] and velocities [m/s], shape (2, len(times),
        n_blocks).

        Only the first `n_blocks` blocks are returned, by default all.
        """
        # Imported here: reading a run must not load Numba.
        from precursors.solver import kernel

        when = self._times(times)
        order = np.argsort(when, kind="stable")
        states = kernel.evaluate(
            self.chain,
            when[order],
            self.transitions,
            self.intervals,
            self.states,
            n_blocks or self.chain.n_blocks,
        )
        return states[:, np.argsort(order)]

    def _times(self, times: ArrayLike) -> FloatArray:
        when = np.atleast_1d(number_array("times", times, "s"))
        if when.ndim > 1:
            raise ValueError(
                f"times must be one number [s] or a list of them, but have shape {when.shape}"
            )
        outside = ~((when >= 0.0) & (when <= self.duration))
        if outside.any():
            raise ValueError(
                f"times must be between 0 and {self.duration:g} s, but one is {when[outside][0]} s"
            )
        return when
