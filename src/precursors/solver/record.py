"""Types of a record: transitions, and the states stored between them."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from precursors.model.chain import FloatArray

IntArray = NDArray[np.int64]

TRANSITION = np.dtype(
    [("time", "f8"), ("block", "i4"), ("mode", "i1"), ("tangential_load", "f8")]
)
COLUMNS = list(TRANSITION.names or ())


class States(NamedTuple):
    """Stored states, a row each; row 0 is the start, before any transition.

    Spring forces [N], velocities [m/s] and modes, each (S, N); the number of
    transitions before, and the time since the last of them [s].
    """

    force: FloatArray
    velocity: FloatArray
    mode: IntArray
    after: IntArray
    offset: FloatArray

    @classmethod
    def from_rows(cls, rows: FloatArray) -> States:
        """States from rows of `after`, `offset`, N forces, N velocities and N modes."""
        n = (rows.shape[1] - 2) // 3
        return cls(
            force=rows[:, 2 : 2 + n].copy(),
            velocity=rows[:, 2 + n : 2 + 2 * n].copy(),
            mode=rows[:, 2 + 2 * n :].astype(np.int64),
            after=rows[:, 0].astype(np.int64),
            offset=rows[:, 1].copy(),
        )
