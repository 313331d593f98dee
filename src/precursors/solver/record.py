"""What is recorded of a run: its transitions, and states between them."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from precursors.model.chain import FloatArray

IntArray = NDArray[np.int64]

TRANSITION = np.dtype([("time", "f8"), ("block", "i4"), ("mode", "i1"), ("tangential_load", "f8")])


class States(NamedTuple):
    """Stored states, a row each; row 0 is the start, before any transition.

    Spring forces [N], velocities [m/s] and modes, each (S, N); the number of transitions before, and the time
    since the last of them [s].
    """

    force: FloatArray
    velocity: FloatArray
    mode: IntArray
    after: IntArray
    offset: FloatArray

    @classmethod
    def empty(cls, n_states: int, n_blocks: int) -> States:
        """Room for states of N blocks."""
        force, velocity = np.empty((2, n_states, n_blocks))
        mode = np.empty((n_states, n_blocks), np.int64)
        return cls(force, velocity, mode, np.empty(n_states, np.int64), np.empty(n_states))
