"""Count the leading transitions in which two runs agree."""

import numpy as np
from numpy.typing import NDArray

from precursors.solver.run import Record


def transitions_right(run: Record, true: Record) -> int:
    """Return the number of transitions before the first that is missing or has a wrong
    block or mode."""
    changes = ["block", "mode"]
    return agreeing(run.transitions[changes], true.transitions[changes])


def agreeing(mine: NDArray[np.void], theirs: NDArray[np.void]) -> int:
    """Return the number of leading rows that agree."""
    n = min(len(mine), len(theirs))
    return int(np.argmin(np.append(mine[:n] == theirs[:n], False)))
