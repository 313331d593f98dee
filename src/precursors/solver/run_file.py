"""The HDF5 file of a record or run, whose checksums are checked when it is read."""

from __future__ import annotations

import math
from importlib.metadata import version
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from precursors.model.chain import ARGUMENTS, Chain, remember_theta
from precursors.model.checks import not_negative
from precursors.solver.record import COLUMNS, States
from precursors.support.files import AnyPath, write_whole

if TYPE_CHECKING:
    import h5py

    from precursors.solver.run import Record

FORMAT = "precursors run 6"
LAST_LARGER = "88883c9"  # the last commit with friction that falls, and viscosity
UNITS = {
    "time": "s",
    "block": "1",
    "mode": "1",
    "tangential_load": "N",
    "intervals": "s",
    "start_positions": "m",
    "start_velocities": "m/s",
    "force": "N",
    "velocity": "m/s",
    "after": "1",
    "offset": "s",
    "weights": "N",
}
SCALARS = ARGUMENTS[1:]


class RunFileError(ValueError):
    """A file that is not a whole run of this format."""


def write_record(record: Record, path: AnyPath) -> None:
    """Write a record or run to an HDF5 file, whole or not at all."""
    import h5py  # slow, and needed for files only

    chain = record.chain
    texts = {
        "format": FORMAT,
        "precursors": version("precursors"),
        "numpy": np.__version__,
        "duration_unit": "s",
    }
    scalars = {name: getattr(chain, name) for name in [*SCALARS, "theta"]}
    datasets = {"weights": chain.weights}
    for name, value in vars(record).items():
        if name == "transitions":
            datasets |= {f"transitions/{column}": value[column] for column in COLUMNS}
        elif name == "states":
            datasets |= {
                f"states/{column}": of for column, of in value._asdict().items()
            }
        elif isinstance(value, np.ndarray):
            datasets[name] = value
        elif name != "chain":
            scalars[name] = value

    # HDF5 may end the interpreter when the disk is full, so the file is made in memory
    # first.
    memory = BytesIO()
    with h5py.File(memory, "w", libver="v110") as file:
        # Of a fixed length: HDF5 has checksums for all but the texts that have none,
        # and may hang in these.
        file.attrs.update(
            {name: np.bytes_(text.encode()) for name, text in texts.items()}
        )
        file.attrs.update(scalars)
        for name, values in datasets.items():
            data = file.create_dataset(
                name, data=values, compression="gzip", shuffle=True, fletcher32=True
            )
            data.attrs["unit"] = np.bytes_(UNITS[name.split("/")[-1]])
    write_whole(path, memory.getvalue())


def read_record(path: AnyPath) -> dict[str, Any]:
    """Read what `Record.from_columns` takes; `RunFileError` says why a file has
    none."""
    import h5py

    if not Path(path).is_file():
        raise FileNotFoundError(
            f"{path} is not a file" if Path(path).exists() else f"{path}: no such file"
        )
    # HDF5 asks for locks, which a file system may not have; nor are links followed.
    memory = BytesIO(Path(path).read_bytes())
    try:
        with h5py.File(memory, "r") as file:
            if _text(file, "format") != FORMAT:
                raise ValueError(f"its format is not {FORMAT!r}, which is read here")
            if "load_points" in file:
                raise RunFileError(
                    f"{path} is a run of a larger chain, which commit {LAST_LARGER} was "
                    f"the last to have: git checkout {LAST_LARGER} reads it"
                )
            return _content(file)
    except RunFileError:
        raise
    except Exception as error:  # nearly any, as the file may hold anything
        reason = " ".join(str(error).split()).strip("'\"")
        raise RunFileError(
            f"{path} is not a run file, or is damaged: {reason}"
        ) from error


def _content(file: h5py.File) -> dict[str, Any]:
    """Columns and further attributes of the record in a file."""
    names = ["weights", "intervals", *(f"transitions/{name}" for name in COLUMNS)]
    if "states" in file:
        names += ["start_positions", "start_velocities"]
        names += [f"states/{name}" for name in States._fields]
    found = {name: np.array(file[name]) for name in names}
    scalars = {name: float(file.attrs[name]) for name in SCALARS}
    duration = not_negative("duration", float(file.attrs["duration"]), "s")
    chain = Chain(weights=found.pop("weights"), **scalars)
    theta = float(file.attrs["theta"])
    if not math.isnan(theta):
        remember_theta(chain, theta)
    content: dict[str, Any] = {"chain": chain, "duration": duration}
    content |= {name: found.pop(f"transitions/{name}") for name in COLUMNS}
    if "states/after" in found:
        states = [found.pop(f"states/{name}") for name in States._fields]
        content["states"] = States(*states)
        content["evaluations"] = float(file.attrs["evaluations"])
    return content | found


def _text(file: h5py.File, name: str) -> str:
    """A text of fixed length, or nothing."""
    is_fixed = name in file.attrs and file.attrs.get_id(name).dtype.kind == "S"
    return bytes(file.attrs[name]).decode() if is_fixed else ""
