"""The table of a run's slip events that figures are drawn from."""

from __future__ import annotations

import pandas as pd

from precursors.analysis.slips import find_precursors, find_slips
from precursors.solver.run import Run

WITH_UNITS = {
    "onset": "onset_s",
    "end": "end_s",
    "load_before": "load_before_N",
    "load_after": "load_after_N",
}


def slip_table(run: Run) -> pd.DataFrame:
    """Every slip event of a run, units in the names; `kept` tells the rows of Fig. 13."""
    slips = find_slips(run)
    kept = slips.index.isin(find_precursors(slips).index)
    return slips.rename(columns=WITH_UNITS).assign(kept=kept)
