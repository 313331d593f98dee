"""A run: the transitions of a chain, the states between them, and its file."""

from __future__ import annotations

from dataclasses import dataclass, replace
from os import PathLike
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from precursors.model.chain import Chain, FloatArray
from precursors.model.checks import number_array
from precursors.solver.record import TRANSITION, States, room_for_states
from precursors.solver.run_file import RunFileError, read_run, write_run

__all__ = ["TRANSITION", "Run", "RunFileError", "States"]


@dataclass(frozen=True, eq=False)
class Run:
    """The motion of a chain from time 0 to `duration`, known exactly at every time.

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
        Time [s] from the start to the first transition, between transitions, and from
        the last one to the end; it resolves what a difference of two absolute times
        cannot.
    start_positions, start_velocities : array, shape (N,)
        State at time 0 [m], [m/s].
    states : States
        Stored states from which `at` starts.
    evaluations : float
        Evaluations of the forces of the whole chain that the solver made, each
        derivative counted as one; 0 where it is not known.
    slider : dict or None
        Arguments of `Chain.from_slider` that the chain was made from, theta as a float;
        None if not known.
    larger : dict or None
        Of a larger chain, its numbers and its accuracy (see `hierarchy.larger`); None
        of the paper's chain.
    load_points : array, shape (n, 2), or None
        Of a larger chain, times [s] and F_X [N] between which straight lines draw the
        load.
    """

    chain: Chain
    duration: float
    transitions: NDArray[np.void]
    intervals: FloatArray
    start_positions: FloatArray
    start_velocities: FloatArray
    states: States
    evaluations: float = 0.0
    slider: dict[str, Any] | None = None
    larger: dict[str, float] | None = None
    load_points: FloatArray | None = None

    def __repr__(self) -> str:
        return f"Run of {self.duration:g} s with {len(self.transitions)} transitions\n{self.chain!r}"

    @classmethod
    def from_transitions(
        cls,
        chain: Chain,
        duration: float,
        time: ArrayLike,
        block: ArrayLike,
        mode: ArrayLike,
        tangential_load: ArrayLike,
        intervals: ArrayLike | None = None,
    ) -> Run:
        """Make a run, from rest with springs at natural length, from columns of its
        transitions.

        It knows no states between them, so that `at` refuses. `intervals` are by
        default differences of `time`, whose rounding grows with the time.
        """
        transitions = np.empty(len(np.atleast_1d(np.asarray(time))), dtype=TRANSITION)
        transitions["time"] = time
        transitions["block"] = block
        transitions["mode"] = mode
        transitions["tangential_load"] = tangential_load
        if intervals is None:
            intervals = np.diff(
                np.concatenate([[0.0], transitions["time"], [duration]])
            )
        at_rest = np.zeros(chain.n_blocks)
        return cls(
            chain=chain,
            duration=float(duration),
            transitions=transitions,
            intervals=np.array(intervals, dtype=np.float64),
            start_positions=at_rest,
            start_velocities=at_rest,
            states=States.from_rows(room_for_states(0, chain.n_blocks)),
        )

    def at(self, times: ArrayLike) -> tuple[FloatArray, FloatArray]:
        """Positions [m] and velocities [m/s], each (len(times), N), exact to
        rounding."""
        when = self._times(times)
        force, velocity = self.forces_and_velocities(when)
        # x_1 = V t - T_1/K (Eq. 3), x_2 = x_1 - T_2/k, ...
        behind = np.cumsum(force / self.chain.springs, axis=1)
        return self.chain.drive_velocity * when[:, None] - behind, velocity

    def tangential_load(self, times: ArrayLike) -> FloatArray:
        """Tangential load F_X = K(V t - x_1) [N], shape (len(times),) (Eq. 3)."""
        return self.forces_and_velocities(times)[0][:, 0]

    def spring_forces(self, times: ArrayLike) -> FloatArray:
        """Force in the spring behind each block [N], shape (len(times), N); column 0 is
        F_X."""
        return self.forces_and_velocities(times)[0]

    def forces_and_velocities(self, times: ArrayLike) -> tuple[FloatArray, FloatArray]:
        """Spring forces [N] and velocities [m/s], each (len(times), N): the state,
        apart from the drive's."""
        when = self._times(times)
        if self.larger is not None:
            raise ValueError(
                "the run of a larger chain knows its transitions and load_points only"
            )
        if len(self.states.after) == 0:
            raise ValueError(
                "the run has no stored states: only a run that simulate made can be evaluated"
            )
        # Who only reads a run waits for no compiler.
        from precursors.solver import kernel

        order = np.argsort(when, kind="stable")
        force, velocity = kernel.evaluate(
            self.chain, when[order], self.transitions, self.intervals, self.states
        )
        back = np.argsort(order, kind="stable")
        return force[back], velocity[back]

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

    def save(
        self, path: str | PathLike[str], slider: dict[str, Any] | None = None
    ) -> None:
        """Write the run to an HDF5 file, whole or not at all; its directory is made if
        it is missing.

        `slider` are arguments of `Chain.from_slider` to keep in the file, by default
        those of the run.
        """
        write_run(self if slider is None else replace(self, slider=slider), path)

    @classmethod
    def load(cls, path: str | PathLike[str]) -> Run:
        """Read a run from a file that `save` wrote; any other file is a
        `RunFileError`."""
        return cls(**read_run(path))
