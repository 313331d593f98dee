"""The arrays of a record: transitions, stored states, and checks of them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from precursors.model.chain import FREE, FloatArray

IntArray = NDArray[np.int64]

TRANSITION = np.dtype(
    [("time", "f8"), ("block", "i4"), ("mode", "i1"), ("tangential_load", "f8")]
)
COLUMNS = list(TRANSITION.names or ())


class States(NamedTuple):
    """Stored states, one per row; row 0 is the start, before any transition.

    `force` [N], `velocity` [m/s] and `mode` have shape (S, N). `after` is the number of
    transitions before the state, and `offset` the time since the last of them [s].
    """

    force: FloatArray
    velocity: FloatArray
    mode: IntArray
    after: IntArray
    offset: FloatArray

    @classmethod
    def from_rows(cls, rows: FloatArray) -> States:
        """Split rows of `after`, `offset`, N forces, N velocities and N modes."""
        n = (rows.shape[1] - 2) // 3
        return cls(
            force=rows[:, 2 : 2 + n].copy(),
            velocity=rows[:, 2 + n : 2 + 2 * n].copy(),
            mode=rows[:, 2 + 2 * n :].astype(np.int64),
            after=rows[:, 0].astype(np.int64),
            offset=rows[:, 1].copy(),
        )


class Dataset(NamedTuple):
    """Unit, type and shape of an array of a record; equal names in shapes stand for
    equal lengths."""

    unit: str
    type: str
    shape: tuple[str, ...]


# The arrays of a record and of its chain, by their names in a file.
DATASETS = {
    "weights": Dataset("N", "f8", ("blocks",)),
    "intervals": Dataset("s", "f8", ("intervals",)),
    "transitions/time": Dataset("s", "f8", ("transitions",)),
    "transitions/block": Dataset("1", "i4", ("transitions",)),
    "transitions/mode": Dataset("1", "i1", ("transitions",)),
    "transitions/tangential_load": Dataset("N", "f8", ("transitions",)),
    "start_positions": Dataset("m", "f8", ("blocks",)),
    "start_velocities": Dataset("m/s", "f8", ("blocks",)),
    "states/force": Dataset("N", "f8", ("states", "blocks")),
    "states/velocity": Dataset("m/s", "f8", ("states", "blocks")),
    "states/mode": Dataset("1", "i8", ("states", "blocks")),
    "states/after": Dataset("1", "i8", ("states",)),
    "states/offset": Dataset("s", "f8", ("states",)),
}


def arrays_of(record: Any) -> dict[str, NDArray[Any]]:
    """Return the arrays of a record or run and of its chain, by their names in
    `DATASETS`."""
    arrays = {"weights": record.chain.weights, "intervals": record.intervals}
    arrays |= {f"transitions/{name}": record.transitions[name] for name in COLUMNS}
    if hasattr(record, "states"):
        arrays["start_positions"] = record.start_positions
        arrays["start_velocities"] = record.start_velocities
        states = record.states._asdict()
        arrays |= {f"states/{name}": values for name, values in states.items()}
    return arrays


def find_shape_error(arrays: Mapping[str, Any]) -> str:
    """Describe the first array that has a wrong type, or a shape that does not fit the
    others; return "" if there is none.

    The arrays may be in memory or in a file.
    """
    lengths: dict[str, int] = {}
    for name, array in arrays.items():
        dataset = DATASETS[name]
        if array.dtype != dataset.type:
            return f"{name} is of type {array.dtype} and not {np.dtype(dataset.type)}"
        fits = len(array.shape) == len(dataset.shape) and all(
            lengths.setdefault(axis, length) == length
            for axis, length in zip(dataset.shape, array.shape, strict=True)
        )
        if not fits:
            wanted = [lengths.get(axis, axis) for axis in dataset.shape]
            return f"{name} has the shape {array.shape} and not {tuple(wanted)}"
    n = lengths["transitions"]
    if lengths["intervals"] != n + 1:
        return f"{n} transitions need {n + 1} intervals, the run has {lengths['intervals']}"
    return ""


def find_range_error(arrays: Mapping[str, NDArray[Any]]) -> str:
    """Describe the first impossible block, mode, interval or stored state; return "" if
    there is none.

    The arrays must have the right shapes.
    """
    intervals = arrays["intervals"]
    if not np.all((intervals >= 0) & np.isfinite(intervals)):
        return "an interval is negative or not finite"
    block = arrays["transitions/block"]
    mode = arrays["transitions/mode"]
    is_wrong = (block < 1) | (block > len(arrays["weights"]))
    is_wrong |= (mode < -1) | (mode > 1)
    for k in np.flatnonzero(is_wrong)[:1]:
        return f"transition {k} has block {block[k]}, mode {mode[k]}: there is no such block or mode"
    if "states/after" not in arrays:
        return ""
    after = arrays["states/after"]
    offset = arrays["states/offset"]
    if not (len(after) and after[0] == offset[0] == 0):
        return "the first stored state is not that of the start"
    is_wrong = (after < 0) | (after > len(block))
    is_wrong |= ~((offset >= 0) & (offset <= intervals[np.where(is_wrong, 0, after)]))
    is_wrong[1:] |= np.diff(after) < 0
    is_wrong[1:] |= (np.diff(after) == 0) & (np.diff(offset) < 0)
    modes = arrays["states/mode"]
    is_wrong |= ((modes < -1) | (modes > FREE)).any(axis=1)
    for row in np.flatnonzero(is_wrong)[:1]:
        return (
            f"stored state {row}, {offset[row]:.6g} s after transition {after[row]}, "
            "has an impossible time or mode"
        )
    return ""
