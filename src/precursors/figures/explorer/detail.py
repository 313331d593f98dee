"""What the explorer shows of a run beside its load and its slips: which block slides when."""

from __future__ import annotations

import numpy as np
import pandas as pd

from precursors.model.chain import FloatArray
from precursors.solver.run import Run


def find_slides(run: Run, onsets: FloatArray) -> pd.DataFrame:
    """Every slide of a block: from the transition that starts it to the block's next one.

    Parameters
    ----------
    run : Run
        The run.
    onsets : array
        Onset of each slip event [s], in order.

    Returns
    -------
    DataFrame
        event (from 1), block (1..N), mode (+1, -1), start, end [s], load (F_X at the start) [N].
    """
    transitions = run.transitions
    order = np.lexsort((np.arange(len(transitions)), transitions["block"]))
    same = np.append(np.diff(transitions["block"][order]) == 0, False)
    end = np.empty(len(transitions))
    end[order] = np.where(same, np.append(transitions["time"][order][1:], np.nan), run.duration)
    slides = transitions["mode"] != 0
    start = transitions["time"][slides]
    return pd.DataFrame(
        {
            "event": np.searchsorted(onsets, start, side="right").astype(np.int32),
            "block": transitions["block"][slides],
            "mode": transitions["mode"][slides].astype(np.int32),
            "start": start,
            "end": end[slides],
            "load": transitions["tangential_load"][slides],
        }
    )
