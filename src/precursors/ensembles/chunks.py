"""Chunks of a study: how it is cut, what the file of a chunk holds, and how chunks are gathered."""

from __future__ import annotations

import math
from collections.abc import Iterable
from importlib.metadata import version
from io import BytesIO
from itertools import pairwise
from os import PathLike
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from precursors.ensembles.cost import seconds_of_long_run, seconds_of_ringing, seconds_to_first_slip
from precursors.ensembles.study import Study
from precursors.model.chain import FloatArray, positive
from precursors.model.slider import SLIDER, loading_time
from precursors.support.files import write_whole

if TYPE_CHECKING:
    import pandas as pd

FORMAT = "precursors chunk 1"


def estimated_seconds(study: Study) -> FloatArray:
    """Time that each member is expected to take on one core [s], shape (n_members,)."""
    n_blocks = study.column("n_blocks")
    additions = study.column("interface_stiffness"), study.column("viscosity")
    if study.until is not None:
        return seconds_to_first_slip(n_blocks, *additions)
    loadings = study.column("duration") / loading_time({name: study.column(name) for name in SLIDER})
    slipping = seconds_of_long_run(n_blocks, loadings, study.column("mu_k") / study.column("mu_s"))
    return slipping + loadings * seconds_of_ringing(n_blocks, *additions)


def plan_chunks(study: Study, seconds: float) -> list[tuple[int, int]]:
    """Ranges of members (first, last + 1), each worth about so many seconds on one core.

    Raises
    ------
    ValueError
        If `seconds` is not positive.
    """
    elapsed = np.cumsum(estimated_seconds(study))
    if not len(elapsed):
        return []
    n_chunks = min(len(elapsed), math.ceil(elapsed[-1] / positive("seconds", seconds, "s")))
    ends = np.searchsorted(elapsed, elapsed[-1] * np.arange(1, n_chunks) / n_chunks)
    bounds = np.unique([0, *ends, len(elapsed)]).tolist()
    return list(pairwise(bounds))


def save_chunk(path: str | PathLike[str], study: Study, first: int, results: NDArray[np.void]) -> None:
    """Write what members `first`, `first` + 1, ... of a study gave to an HDF5 file with a checksum.

    Raises
    ------
    OSError
        If the file cannot be written.
    """
    import h5py

    from precursors.analysis.summary import SUMMARY_UNITS  # a plan of chunks waits for no compiler

    memory = BytesIO()  # HDF5 does not survive a full disk
    with h5py.File(memory, "w") as file:
        file.attrs["format"] = FORMAT
        file.attrs["study"], file.attrs["fingerprint"] = study.name, study.fingerprint
        file.attrs["first"] = first
        for package in ("precursors", "numpy", "numba"):
            file.attrs[package] = version(package)
        for name in results.dtype.names or ():
            data = file.create_dataset(
                name, data=results[name], compression="gzip", shuffle=True, fletcher32=True
            )
            data.attrs["unit"] = SUMMARY_UNITS.get(name, "1")
    with write_whole(path) as temporary:
        temporary.write_bytes(memory.getvalue())


def load_chunk(path: str | PathLike[str], study: Study) -> tuple[int, dict[str, NDArray]]:
    """First member of a chunk, and the columns of its results, the unit at the end of a name (load_N).

    Raises
    ------
    FileNotFoundError
        If there is no such file.
    ValueError
        If the file is not a whole chunk of this format, or one of another study.
    """
    import h5py

    with h5py.File(path, "r") as file:
        if file.attrs["fingerprint"] != study.fingerprint:
            raise ValueError(
                f"{path}: a chunk of {file.attrs['study']!r}, not of {study.name!r} as it is now: remove it"
            )
        columns = {_with_unit(name, data.attrs["unit"]): data[()] for name, data in file.items()}
        return int(file.attrs["first"]), columns


def gather(study: Study, paths: Iterable[str | PathLike[str]]) -> pd.DataFrame:
    """One tidy table of a study from its chunks: what each member is, and what it gave.

    Raises
    ------
    ValueError
        If a chunk is damaged or of another study, or the chunks are not all members, each once.
    """
    import pandas as pd

    chunks = sorted((load_chunk(path, study) for path in paths), key=lambda chunk: chunk[0])
    rows = [np.arange(first, first + len(columns["reached"])) for first, columns in chunks]
    if not np.array_equal(np.concatenate([[], *rows]), np.arange(len(study))):
        raise ValueError(f"study {study.name}: the chunks are not its {len(study)} members, each once")
    results = pd.concat([pd.DataFrame(columns) for _, columns in chunks], ignore_index=True)
    return pd.concat([pd.DataFrame(dict(study.columns)), results], axis=1)


def _with_unit(name: str, unit: str) -> str:
    return name if unit == "1" else f"{name}_{unit}"
