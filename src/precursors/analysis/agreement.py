"""How far the transitions of a run are those of another."""

import numpy as np
from numpy.typing import NDArray

from precursors.solver.run import Record


def transitions_right(run: Record, true: Record) -> int:
    """Number of transitions before the first that is missing or whose block or mode is
    wrong."""
    changes = ["block", "mode"]
    return agreeing(run.transitions[changes], true.transitions[changes])


def agreeing(mine: NDArray[np.void], theirs: NDArray[np.void]) -> int:
    """Number of rows that agree before the first that does not, or an end."""
    n = min(len(mine), len(theirs))
    return int(np.argmin(np.append(mine[:n] == theirs[:n], False)))
