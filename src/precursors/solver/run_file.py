"""Write and read the HDF5 file of a record or run; reading checks all of it."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Mapping
from importlib.metadata import version
from io import BytesIO
from numbers import Real
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from precursors.model.chain import ARGUMENTS, Chain, remember_theta
from precursors.model.checks import not_negative
from precursors.solver.record import (
    COLUMNS,
    DATASETS,
    States,
    arrays_of,
    find_range_error,
    find_shape_error,
)
from precursors.support.files import AnyPath, write_whole

if TYPE_CHECKING:
    import h5py

    from precursors.solver.run import Record

FORMAT = "precursors run 7"
WITHOUT_CHECKSUM = "precursors run 6"  # the same format without a checksum
TEXTS = ["format", "precursors", "numpy", "duration_unit"]
LAST_LARGER = "88883c9"  # the last commit with weakening friction and viscosity
SCALARS = ARGUMENTS[1:]
GROUPS = ("transitions", "states")
# Largest ratio of an array's bytes to its bytes in the file; gzip reaches at most 1032.
MOST_COMPRESSED = 1100


class RunFileError(ValueError):
    """A file that is not a complete run of this format."""


def write_record(record: Record, path: AnyPath) -> None:
    """Write a record or run to an HDF5 file, completely or not at all."""
    import h5py  # imported lazily: it is slow, and only files need it

    attributes: dict[str, Any] = {
        "format": FORMAT,
        "precursors": version("precursors"),
        "numpy": np.__version__,
        "duration_unit": "s",
        **{name: getattr(record.chain, name) for name in [*SCALARS, "theta"]},
        **{name: x for name, x in vars(record).items() if isinstance(x, Real)},
    }
    # Texts have a fixed length: HDF5 has no checksum for texts of variable length, and
    # may hang if they are damaged.
    attributes = {
        name: np.bytes_(value.encode()) if isinstance(value, str) else value
        for name, value in attributes.items()
    }
    arrays = arrays_of(record)
    attributes["checksum"] = checksum(attributes, arrays)

    # A full disk can make HDF5 end the interpreter, so the file is made in memory
    # first.
    memory = BytesIO()
    with h5py.File(memory, "w", libver="v110") as file:
        file.attrs.update(attributes)
        for name, values in arrays.items():
            data = file.create_dataset(
                name, data=values, compression="gzip", shuffle=True, fletcher32=True
            )
            data.attrs["unit"] = np.bytes_(DATASETS[name].unit.encode())
    write_whole(path, memory.getvalue())


def checksum(attributes: Mapping[str, Any], arrays: Mapping[str, Any]) -> np.bytes_:
    """Return the SHA-256 of the names, types, shapes and values of a file's content."""
    digest = hashlib.sha256()
    for name, values in sorted({**attributes, **arrays}.items()):
        array = np.asarray(values)
        digest.update(f"{name} {array.dtype.str} {array.shape} ".encode())
        digest.update(array.tobytes())
    return np.bytes_(digest.hexdigest().encode())


def has_checksum(path: AnyPath) -> bool:
    """Whether a run file has a checksum; those of the first releases have none."""
    import h5py

    with h5py.File(BytesIO(Path(path).read_bytes()), "r") as file:
        return "checksum" in file.attrs


def read_record(path: AnyPath) -> dict[str, Any]:
    """Read the arguments of `Record.from_columns` from a file.

    Raises
    ------
    FileNotFoundError
        If there is no such file.
    RunFileError
        If it is another kind of file, or damaged.
    """
    import h5py

    if not Path(path).is_file():
        raise FileNotFoundError(
            f"{path} is not a file" if Path(path).exists() else f"{path}: no such file"
        )
    # Read into memory: HDF5 needs file locks, which some file systems lack.
    memory = BytesIO(Path(path).read_bytes())
    try:
        with h5py.File(memory, "r") as file:
            if "load_points" in file:
                raise RunFileError(
                    f"{path} is a run of an older model, which this version cannot "
                    f"read: git checkout {LAST_LARGER} reads it"
                )
            return _content(file)
    except RunFileError:
        raise
    except Exception as error:  # any error, as the file may have any content
        reason = " ".join(str(error).split()).strip("'\"")
        raise RunFileError(
            f"{path} is not a run file, or is damaged: {reason}"
        ) from error


def _content(file: h5py.File) -> dict[str, Any]:
    """Return the columns and further attributes of the record in a file."""
    attributes = _attributes(file)
    form = bytes(attributes.get("format", b"")).decode()
    if form not in (FORMAT, WITHOUT_CHECKSUM):
        raise ValueError(f"its format is not {FORMAT!r}, which is read here")
    stored = _datasets(file)
    datasets = ["weights", "intervals", *(f"transitions/{name}" for name in COLUMNS)]
    wanted = [*TEXTS, *SCALARS, "theta", "duration"]
    if "states/after" in stored:
        datasets = list(DATASETS)
        wanted.append("evaluations")
    if form == FORMAT:
        wanted.append("checksum")
    _check_names("dataset", stored, datasets)
    _check_names("attribute", attributes, wanted)
    if reason := find_shape_error(stored):
        raise ValueError(reason)

    arrays = {name: stored[name][()] for name in datasets}
    expected = attributes.pop("checksum", None)
    if expected is not None and expected != checksum(attributes, arrays):
        raise ValueError("its content does not match its checksum")
    if reason := find_range_error(arrays):
        raise ValueError(reason)
    scalars = {name: attributes[name] for name in SCALARS}
    chain = Chain(weights=arrays.pop("weights"), **scalars)
    theta = attributes["theta"]
    if theta == theta:  # NaN: unknown
        remember_theta(chain, theta)
    content: dict[str, Any] = {"chain": chain}
    content["duration"] = not_negative("duration", attributes["duration"], "s")
    content |= {name: arrays.pop(f"transitions/{name}") for name in COLUMNS}
    if "states/after" in arrays:
        states = [arrays.pop(f"states/{name}") for name in States._fields]
        content["states"] = States(*states)
        evaluations = not_negative("evaluations", attributes["evaluations"], "1")
        content["evaluations"] = evaluations
    return content | arrays


def _attributes(of: h5py.HLObject) -> dict[str, Any]:
    """Return attributes, which must be numbers or texts of fixed length."""
    for name in of.attrs:
        stored = of.attrs.get_id(name)
        if stored.shape != () or stored.dtype.kind not in "Siuf":
            raise ValueError(f"its attribute {name} is not a number or text")
    return dict(of.attrs)


def _datasets(group: h5py.Group, path: str = "") -> dict[str, h5py.Dataset]:
    """Return the datasets of the file by name, without reading them."""
    import h5py

    datasets: dict[str, h5py.Dataset] = {}
    for key in group:
        name = path + key
        if not isinstance(group.get(key, getlink=True), h5py.HardLink):
            raise ValueError(f"{name} is a link")
        item = group[key]
        attributes = {}
        if name in GROUPS and isinstance(item, h5py.Group):
            datasets |= _datasets(item, f"{name}/")
        elif name not in DATASETS or not isinstance(item, h5py.Dataset):
            raise ValueError(f"{name} is not a dataset of a run")
        elif item.is_virtual or item.external:
            raise ValueError(f"{name} is stored in another file")
        elif item.nbytes > MOST_COMPRESSED * item.id.get_storage_size():
            raise ValueError(f"{name} is incomplete")
        else:
            attributes = {"unit": DATASETS[name].unit.encode()}
            datasets[name] = item
        if _attributes(item) != attributes:
            raise ValueError(f"the attributes of {name} are not {attributes}")
    return datasets


def _check_names(kind: str, given: Iterable[str], wanted: Iterable[str]) -> None:
    """Refuse names that are missing or unknown."""
    for name in sorted(set(given) ^ set(wanted)):
        what = "missing" if name in wanted else "unknown"
        raise ValueError(f"its {kind} {name} is {what}")
