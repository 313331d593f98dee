"""A run: the transitions of a chain, the states between them, and its file."""

from __future__ import annotations

import json
from dataclasses import dataclass, fields
from importlib.metadata import version
from io import BytesIO
from os import PathLike
from pathlib import Path
from typing import Any

import h5py
import numpy as np
from numpy.typing import ArrayLike, NDArray

from precursors.model.chain import Chain, FloatArray
from precursors.solver import kernel
from precursors.solver.kernel import States
from precursors.support.files import write_whole

TRANSITION = np.dtype([("time", "f8"), ("block", "i4"), ("mode", "i1"), ("tangential_load", "f8")])
UNITS = {
    "time": "s",
    "block": "1",
    "mode": "1",
    "tangential_load": "N",
    "intervals": "s",
    "start_positions": "m",
    "start_velocities": "m/s",
    "force": "N",
    "velocity": "N/tau",
    "after": "1",
    "offset": "s",
    "grip": "N",
    "weights": "N",
}
FORMAT = "precursors run 2"


class RunFileError(ValueError):
    """A file that is not a whole run of this format."""


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
        time [s], block (1..N), mode (+1 slides forward, 0 sticks, -1 slides backward), tangential_load [N].
    intervals : array, shape (n_transitions + 1,)
        Time [s] from the start to the first transition, between transitions, and from the last one to the
        end; it resolves what a difference of two absolute times cannot.
    start_positions, start_velocities : array, shape (N,)
        State at time 0 [m], [m/s].
    states : States
        Stored states from which `at` starts.
    evaluations : float
        Evaluations of the forces of the whole chain that the solver made, each derivative counted as one; 0
        where it is not known.
    slider : dict or None
        Arguments of `Chain.from_slider` that the chain was made from, theta as a float; None if not known.
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
        """Make a run from its transitions; it knows no states between them, so that `at` refuses.

        Parameters
        ----------
        chain : Chain
            The chain that moved, from rest with springs at natural length.
        duration : float
            Time reached [s].
        time, block, mode, tangential_load : array_like, shape (n,)
            When [s], which block (1..N), its new mode (+1, 0, -1) and F_X [N].
        intervals : array_like, shape (n + 1,), optional
            Seconds to the first transition, between them and to the end; by default differences of `time`,
            whose rounding grows with the time.
        """
        transitions = np.empty(len(np.atleast_1d(np.asarray(time))), dtype=TRANSITION)
        transitions["time"], transitions["block"], transitions["mode"] = time, block, mode
        transitions["tangential_load"] = tangential_load
        if intervals is None:
            intervals = np.diff(np.concatenate([[0.0], transitions["time"], [duration]]))
        at_rest = np.zeros(chain.n_blocks)
        return cls(
            chain=chain,
            duration=float(duration),
            transitions=transitions,
            intervals=np.array(intervals, dtype=np.float64),
            start_positions=at_rest,
            start_velocities=at_rest,
            states=States.none(chain.n_blocks),
        )

    def at(self, times: ArrayLike) -> tuple[FloatArray, FloatArray]:
        """Positions [m] and velocities [m/s], each (len(times), N), exact to rounding.

        Raises
        ------
        ValueError
            If a time lies outside the run, or the run has no stored states to start from.
        """
        when = self._times(times)
        force, velocity = self._evaluate(when)
        return kernel.to_positions(self.chain, when, force), velocity

    def tangential_load(self, times: ArrayLike) -> FloatArray:
        """Tangential load F_X = K(V t - x_1) [N], shape (len(times),) (Eq. 3)."""
        return self._evaluate(self._times(times))[0][:, 0]

    def spring_forces(self, times: ArrayLike) -> FloatArray:
        """Force in the spring behind each block [N], shape (len(times), N); column 0 is F_X."""
        return self._evaluate(self._times(times))[0]

    def forces_and_velocities(self, times: ArrayLike) -> tuple[FloatArray, FloatArray]:
        """Spring forces [N] and velocities [m/s], each (len(times), N): the state, apart from the drive's."""
        return self._evaluate(self._times(times))

    def horizon(self, tolerance: float) -> float:
        """Time [s] up to which the transitions hold: their order is right, their times to `tolerance` [s].

        What is counted is rounding, that of the parameters too; `horizon.error_growth` has all about it.

        Raises
        ------
        ValueError
            If the tolerance is not positive, or the run has no stored states to start from.
        """
        from precursors.analysis.horizon import error_growth

        return error_growth(self).horizon(tolerance)

    def _times(self, times: ArrayLike) -> FloatArray:
        when = np.atleast_1d(np.asarray(times, dtype=np.float64))
        outside = ~((when >= 0.0) & (when <= self.duration))
        if outside.any():
            raise ValueError(
                f"times: {when[outside][0]} s lies outside the run: allowed is 0 <= t <= {self.duration:g} s"
            )
        return when

    def _evaluate(self, when: FloatArray) -> tuple[FloatArray, FloatArray]:
        if len(self.states.after) == 0:
            raise ValueError("the run has no stored states: allowed is one from simulate or Run.load")
        order = np.argsort(when, kind="stable")
        record = kernel.Record(
            np.ascontiguousarray(self.transitions["time"]),
            self.transitions["block"].astype(np.int64),
            self.transitions["mode"].astype(np.int64),
            np.ascontiguousarray(self.transitions["tangential_load"]),
            self.intervals,
        )
        force, velocity = kernel.evaluate(self.chain, when[order], record, self.states)
        back = np.argsort(order, kind="stable")
        return force[back], velocity[back]

    def save(self, path: str | PathLike[str], slider: dict[str, Any] | None = None) -> None:
        """Write the run to an HDF5 file, under a temporary name until it is whole.

        Parameters
        ----------
        path : path-like
            The file; its directory is made if it is missing.
        slider : dict, optional
            Arguments of `Chain.from_slider` that the chain was made from, theta as a float; by default those
            of the run. They are kept as JSON in the attributes, and `load` gives them back.

        Raises
        ------
        OSError
            If the file cannot be written.
        """
        content = self._content()
        memory = BytesIO()  # HDF5 does not survive a full disk
        with h5py.File(memory, "w", libver="v110") as file:
            file.attrs["format"] = FORMAT
            file.attrs["precursors"] = version("precursors")
            file.attrs["numpy"], file.attrs["numba"] = np.__version__, version("numba")
            file.attrs["slider"] = json.dumps(slider or self.slider, sort_keys=True)
            file.attrs["duration"], file.attrs["duration_unit"] = self.duration, "s"
            for field in fields(Chain)[1:]:
                file.attrs[field.name] = getattr(self.chain, field.name)
            for name, values in content.items():
                data = file.create_dataset(
                    name, data=values, compression="gzip", shuffle=True, fletcher32=True
                )
                data.attrs["unit"] = UNITS[name.split("/")[-1]]
        with write_whole(path) as temporary:
            temporary.write_bytes(memory.getvalue())

    def _content(self) -> dict[str, NDArray]:
        columns = {f"transitions/{name}": self.transitions[name] for name in TRANSITION.names or ()}
        return {
            "weights": self.chain.weights,
            "start_positions": self.start_positions,
            "start_velocities": self.start_velocities,
            "intervals": self.intervals,
            **columns,
            **{f"states/{name}": values for name, values in self.states._asdict().items()},
        }

    @classmethod
    def load(cls, path: str | PathLike[str]) -> Run:
        """Read a run from a file that `save` wrote.

        Raises
        ------
        FileNotFoundError
            If there is no such file.
        RunFileError
            If the file is not a whole run of this format.
        """
        if not Path(path).is_file():
            raise FileNotFoundError(f"{path}: no such file")
        try:
            with h5py.File(path, "r") as file:
                if file.attrs.get("format") != FORMAT:
                    raise RunFileError(f'{path} is not a run file of format "{FORMAT}"')
                return cls._read(file)
        except (OSError, KeyError) as error:
            raise RunFileError(f"{path} is not a whole run file: {error}") from None

    @classmethod
    def _read(cls, file: h5py.File) -> Run:
        transitions = np.empty(len(file["transitions/time"]), dtype=TRANSITION)
        for name in TRANSITION.names or ():
            transitions[name] = file[f"transitions/{name}"][()]
        scalars = {field.name: float(file.attrs[field.name]) for field in fields(Chain)[1:]}
        return cls(
            chain=Chain(weights=file["weights"][()], **scalars),
            duration=float(file.attrs["duration"]),
            transitions=transitions,
            intervals=file["intervals"][()],
            start_positions=file["start_positions"][()],
            start_velocities=file["start_velocities"][()],
            states=States(*(file[f"states/{name}"][()] for name in States._fields)),
            slider=json.loads(file.attrs.get("slider", "null")),
        )
