"""The tables of a run that figures are drawn from: its slip events, and the trace of the tangential load."""

from __future__ import annotations

import numpy as np
import pandas as pd

from precursors.chain import FloatArray
from precursors.run import Run
from precursors.slips import find_precursors, find_slips

UNITS = {"onset": "onset_s", "end": "end_s", "load_before": "load_before_N", "load_after": "load_after_N"}
POINTS_PER_SLIP = 12  # a drop is half a cosine or flatter: straight to 1 % of the drop between 14 points


def slip_table(run: Run) -> pd.DataFrame:
    """Every slip event of a run, units in the names; `kept` tells the rows of Fig. 13."""
    slips = find_slips(run)
    kept = slips.index.isin(find_precursors(slips).index)
    return slips.rename(columns=UNITS).assign(kept=kept)


def load_trace(run: Run) -> pd.DataFrame:
    """Exact F_X at the start, at every transition, at points inside every slip, and at the end."""
    times = _trace_times(run)
    return pd.DataFrame({"time_s": times, "tangential_load_N": run.tangential_load(times)})


def _trace_times(run: Run) -> FloatArray:
    """Times [s] to evaluate the load at, in order: while all blocks stick it grows linearly."""
    slips = find_slips(run)
    end = slips["end"].fillna(run.duration)
    inside = np.linspace(slips["onset"], end, POINTS_PER_SLIP + 2)
    return np.unique(np.concatenate([[0.0, run.duration], run.transitions["time"], inside.ravel()]))
