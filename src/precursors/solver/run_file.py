"""The HDF5 file of a record or run: what is written, and what is checked when it is
read."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from importlib.metadata import version
from io import BytesIO
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from precursors.model.chain import ARGUMENTS, FREE, Chain, remember_theta
from precursors.model.checks import not_negative
from precursors.solver.record import COLUMNS, States
from precursors.support.files import write_whole

if TYPE_CHECKING:
    import h5py

    from precursors.solver.run import Record

FORMAT = "precursors run 6"
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
    "load_points": "s, N",
}
COUNTS = ("block", "mode", "after")
SCALARS = ARGUMENTS[1:]
INTERVALS_APART = 1e-9  # of the duration; roundings of 1e7 intervals add up to less


class RunFileError(ValueError):
    """A file that is not a whole run of this format."""


def write_record(record: Record, path: str | PathLike[str]) -> None:
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
        elif name == "numbers":
            texts["numbers"] = json.dumps(value)
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


def read_record(path: str | PathLike[str]) -> dict[str, Any]:
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
            _require(
                _text(file, "format") == FORMAT,
                f"its format is not {FORMAT!r}, which is read here",
            )
            return _content(file)
    except Exception as error:  # nearly any, as the file may hold anything
        reason = " ".join(str(error).split()).strip("'\"")
        raise RunFileError(
            f"{path} is not a run file, or is damaged: {reason}"
        ) from error


def _content(file: h5py.File) -> dict[str, Any]:
    """Columns and further attributes of the record in a file, all checked."""
    names = ["weights", "intervals", *(f"transitions/{name}" for name in COLUMNS)]
    if "load_points" in file:
        names.append("load_points")
    elif "states" in file:
        names += ["start_positions", "start_velocities"]
        names += [f"states/{name}" for name in States._fields]
    found = {name: _numbers(file, name) for name in names}
    scalars = {name: _scalar(file, name) for name in SCALARS}
    duration = not_negative("duration", _scalar(file, "duration"), "s")
    chain = Chain(weights=found.pop("weights"), **scalars)
    theta = _scalar(file, "theta")
    if not math.isnan(theta):
        remember_theta(chain, theta)
    _check(found, duration, chain.n_blocks)
    content: dict[str, Any] = {"chain": chain, "duration": duration}
    content |= {name: found.pop(f"transitions/{name}") for name in COLUMNS}
    if "states/after" in found:
        states = [found.pop(f"states/{name}") for name in States._fields]
        content["states"] = States(*states)
        evaluations = _scalar(file, "evaluations")
        content["evaluations"] = not_negative("evaluations", evaluations, "1")
    if "load_points" in found:
        # "larger" is the name in files written so far.
        numbers = json.loads(_text(file, "numbers") or _text(file, "larger"))
        _require(
            all(isinstance(value, int | float) for value in numbers.values()),
            "numbers is not a table of numbers",
        )
        content["numbers"] = numbers
    return content | found


def _text(file: h5py.File, name: str) -> str:
    """A text of fixed length, or nothing."""
    is_fixed = name in file.attrs and file.attrs.get_id(name).dtype.kind == "S"
    return bytes(file.attrs[name]).decode() if is_fixed else ""


def _scalar(file: h5py.File, name: str) -> float:
    """A real number."""
    value = np.asarray(file.attrs[name])
    _require(value.dtype.kind in "iuf" and value.shape == (), f"{name} is not a number")
    return float(value)


def _numbers(file: h5py.File, name: str) -> NDArray[Any]:
    """An array of finite numbers, which are whole where they count something."""
    values = np.asarray(file[name][()])
    is_count = name.split("/")[-1] in COUNTS
    _require(
        values.dtype.kind in ("iu" if is_count else "iuf"),
        f"{name} is of type {values.dtype}",
    )
    _require(np.isfinite(values).all(), f"{name} is not finite")
    return values.astype(np.int64 if is_count else float)


def _check(found: Mapping[str, NDArray[Any]], duration: float, n_blocks: int) -> None:
    """Refuse arrays that do not fit together, and values out of range."""
    time = found["transitions/time"]
    n = time.size
    after = found.get("states/after", np.zeros(1))
    n_states = after.size
    shapes: dict[str, tuple[int, ...]] = {
        "intervals": (n + 1,),
        "start_positions": (n_blocks,),
        "start_velocities": (n_blocks,),
        "states/force": (n_states, n_blocks),
        "states/velocity": (n_states, n_blocks),
        "states/mode": (n_states, n_blocks),
        "states/after": (n_states,),
        "states/offset": (n_states,),
        "load_points": (len(found.get("load_points", ())), 2),
    }
    # Over a longer span than the run's the motion would be summed for ever.
    span = (0.0, duration)
    limits = {
        "transitions/time": span,
        "transitions/block": (1, n_blocks),
        "transitions/mode": (-1, 1),
        "intervals": span,
        "states/mode": (-1, FREE),
        "states/after": (0, n),
        "states/offset": span,
    }
    for name, values in found.items():
        shape = shapes.get(name, (n,))
        _require(
            values.shape == shape, f"{name} has shape {values.shape} and not {shape}"
        )
        low, high = limits.get(name, (-math.inf, math.inf))
        _require(
            ((values >= low) & (values <= high)).all(),
            f"{name} is not between {low} and {high}",
        )
    _require((np.diff(time) >= 0).all(), "transitions/time is not in order")
    _require((np.diff(after) >= 0).all(), "states/after is not in order")
    _require(n_states > 0 and after[0] == 0, "it has no state of the start")
    instants = np.cumsum(found["intervals"])
    apart = abs(instants - np.append(time, duration)).max()
    _require(
        apart <= INTERVALS_APART * duration, "its intervals do not add up to its times"
    )


def _require(holds: bool | np.bool_, otherwise: str) -> None:
    if not holds:
        raise RunFileError(otherwise)
