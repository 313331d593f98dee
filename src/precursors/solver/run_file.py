"""The HDF5 file of a run: what is written, and what is checked when it is read."""

from __future__ import annotations

import json
from dataclasses import fields
from importlib.metadata import version
from io import BytesIO
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from precursors.model.chain import Chain
from precursors.solver.record import TRANSITION, States
from precursors.support.files import write_whole

if TYPE_CHECKING:
    import h5py

    from precursors.solver.run import Run

FORMAT = "precursors run 5"
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
PLAIN = ("start_positions", "start_velocities", "intervals")
SCALARS = [field.name for field in fields(Chain)[1:]]
# Compiled code takes these types only.
KINDS = {
    "force": float,
    "velocity": float,
    "mode": np.int64,
    "after": np.int64,
    "offset": float,
}
INTERVALS_APART = 1e-9  # of the duration; roundings of 1e7 intervals add up to less


class RunFileError(ValueError):
    """A file that is not a whole run of this format."""


def write_run(run: Run, path: str | PathLike[str]) -> None:
    """Write a run to an HDF5 file, whole or not at all."""
    import h5py  # here, as a run needs no file

    # HDF5 may end the interpreter when the disk is full, so the file is made in memory
    # first.
    memory = BytesIO()
    extra = {} if run.load_points is None else {"load_points": run.load_points}
    datasets = {
        **extra,
        "weights": run.chain.weights,
        **{name: getattr(run, name) for name in PLAIN},
        **{
            f"transitions/{name}": run.transitions[name]
            for name in TRANSITION.names or ()
        },
        **{f"states/{name}": values for name, values in run.states._asdict().items()},
    }
    with h5py.File(memory, "w", libver="v110") as file:
        texts = {
            "format": FORMAT,
            "precursors": version("precursors"),
            "numpy": np.__version__,
            "slider": json.dumps(run.slider, sort_keys=True),
            "larger": json.dumps(run.larger),
            "duration_unit": "s",
        }
        # Of a fixed length: HDF5 has checksums for all but the texts that have none,
        # and may hang in these.
        file.attrs.update(
            {name: np.bytes_(text.encode()) for name, text in texts.items()}
        )
        file.attrs.update({name: getattr(run.chain, name) for name in SCALARS})
        file.attrs.update(duration=run.duration, evaluations=run.evaluations)
        for name, values in datasets.items():
            data = file.create_dataset(
                name, data=values, compression="gzip", shuffle=True, fletcher32=True
            )
            data.attrs["unit"] = np.bytes_(UNITS[name.split("/")[-1]])
    write_whole(path, memory.getvalue())


def read_run(path: str | PathLike[str]) -> dict[str, Any]:
    """Read the fields of a `Run` from a file; `RunFileError` says in one line why it is
    none."""
    import h5py

    if not Path(path).is_file():
        raise FileNotFoundError(
            f"{path} is not a file" if Path(path).exists() else f"{path}: no such file"
        )
    try:
        with h5py.File(path, "r") as file:
            _require(
                _text(file, "format") == FORMAT,
                f"its format is not {FORMAT!r}, which is read here",
            )
            content = _content(file)
        _check(content)
    except Exception as error:  # nearly any, as the file may hold anything
        reason = " ".join(str(error).split()).strip("'\"")
        raise RunFileError(
            f"{path} is not a run file, or is damaged: {reason}"
        ) from error
    return content


def _text(file: h5py.File, name: str) -> str:
    """A text of fixed length, or nothing."""
    is_fixed = name in file.attrs and file.attrs.get_id(name).dtype.kind == "S"
    return bytes(file.attrs[name]).decode() if is_fixed else ""


def _content(file: h5py.File) -> dict[str, Any]:
    columns = {name: file[f"transitions/{name}"][()] for name in TRANSITION.names or ()}
    transitions = np.empty(len(columns["time"]), dtype=TRANSITION)
    for name, values in columns.items():
        _require(
            values.shape == transitions.shape,
            f"transitions/{name} has shape {values.shape}",
        )
        transitions[name] = values
    scalars = {name: float(file.attrs[name]) for name in SCALARS}
    return {
        "chain": Chain(weights=file["weights"][()], **scalars),
        "duration": float(file.attrs["duration"]),
        "transitions": transitions,
        **{name: file[name][()].astype(float) for name in PLAIN},
        "states": States._make(
            file[f"states/{name}"][()].astype(KINDS[name]) for name in States._fields
        ),
        "evaluations": float(file.attrs["evaluations"]),
        "slider": json.loads(_text(file, "slider")),
        "larger": json.loads(_text(file, "larger")),
        "load_points": file["load_points"][()].astype(float)
        if "load_points" in file
        else None,
    }


def _check(content: dict[str, Any]) -> None:
    """Refuse what the compiled code could not run on: wrong shapes, and indices out of
    range."""
    for name in ("slider", "larger"):
        _require(
            content[name] is None or isinstance(content[name], dict),
            f"{name} is not a table",
        )
    transitions = content["transitions"]
    states = content["states"]
    n_blocks = content["chain"].n_blocks
    n = len(transitions)
    _require(
        content["intervals"].shape == (n + 1,),
        f"intervals do not fit to {n} transitions",
    )
    for name in ("start_positions", "start_velocities"):
        _require(
            content[name].shape == (n_blocks,),
            f"{name} do not fit to {n_blocks} blocks",
        )
    block = transitions["block"]
    mode = transitions["mode"]
    after = states.after
    _require(
        ((block >= 1) & (block <= n_blocks)).all(),
        f"a block is not one of 1 to {n_blocks}",
    )
    _require(
        np.isin(mode, (-1, 0, 1)).all() and np.isin(states.mode, (-1, 0, 1)).all(),
        "a mode is unknown",
    )
    # Every span is part of the run: the motion over a longer one would be summed for
    # ever.
    duration = content["duration"]
    ends = np.append(transitions["time"], content["duration"])
    intervals = content["intervals"]
    spread = INTERVALS_APART * duration
    _require(
        ((ends >= 0) & (np.diff(ends, prepend=0.0) >= 0)).all(),
        "its times are not in order",
    )
    _require(
        ((intervals >= 0) & (intervals <= duration)).all(),
        "an interval is not between 0 and the duration",
    )
    _require(
        (abs(np.cumsum(intervals) - ends) <= spread).all(),
        "its intervals do not add up to its times",
    )
    offset = states.offset
    _require(
        ((offset >= 0) & (offset <= duration)).all(),
        "an offset is not between 0 and the duration",
    )
    _require((np.diff(after) >= 0).all(), "its states are not in order")
    _require(
        ((after >= 0) & (after <= n)).all(),
        "a state comes after a transition that is not there",
    )
    shape = (len(after), n_blocks)
    for name in ("force", "velocity", "mode"):
        found = getattr(states, name).shape
        _require(found == shape, f"states/{name} has shape {found} and not {shape}")
    _require(
        states.offset.shape == after.shape, "states/offset does not fit to states/after"
    )


def _require(holds: bool | np.bool_, otherwise: str) -> None:
    if not holds:
        raise RunFileError(otherwise)
