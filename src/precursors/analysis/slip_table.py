"""The table of a run's slip events that figures are drawn from."""

from __future__ import annotations

import numpy as np
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
    """Every slip event of a run, with units in the names of the columns.

    `kept` marks the rows of Fig. 13. theta, n_blocks and normal_load_N (F_Z) say which slider it was, the
    same in every row; theta is NaN where the run does not know its slider.
    """
    slips = find_slips(run)
    return slips.rename(columns=WITH_UNITS).assign(
        kept=slips.index.isin(find_precursors(slips).index),
        theta=run.slider["theta"] if run.slider else np.nan,
        n_blocks=run.chain.n_blocks,
        normal_load_N=run.slider["normal_load"] if run.slider else run.chain.normal_load,
    )
