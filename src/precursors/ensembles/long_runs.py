"""Long runs: the peak loads of hundreds of global slips, one after another."""

from __future__ import annotations

import pandas as pd

from precursors.analysis.slips import find_slips
from precursors.solver.run import Run

QUANTILES = {"q05": 0.05, "q25": 0.25, "q50": 0.5, "q75": 0.75, "q95": 0.95}


def global_slips(run: Run) -> pd.DataFrame:
    """Global slips of a run: onset_s, the peak load load_before_N with mu = F_X/F_Z, and load_after_N.

    F_X falls as soon as block 1 slides, so the load at the onset is the peak.
    """
    slips = find_slips(run)
    slips = slips[slips["is_global"]]
    return pd.DataFrame(
        {
            "onset_s": slips["onset"],
            "load_before_N": slips["load_before"],
            "load_after_N": slips["load_after"],
            "mu": slips["load_before"] / run.chain.normal_load,
        }
    ).reset_index(drop=True)


def long_run_statistics(table: pd.DataFrame) -> pd.DataFrame:
    """Peak loads of the global slips after the first, whose start from rest is unlike the others.

    Parameters
    ----------
    table : DataFrame
        `global_slips` of several scenes, with a column scene.

    Returns
    -------
    DataFrame
        One row per scene: mu_first (that is mu_sapp where no earlier load is larger); the number n of the
        others, the mean of their mu and its standard error (as if they were independent), standard deviation,
        least, quantiles and largest; the mean time between two global slips.
    """
    rows = []
    for scene, slips in table.groupby("scene", sort=False):
        mu = slips["mu"].iloc[1:]
        rows.append(
            {
                "scene": scene,
                "mu_first": slips["mu"].iloc[0],
                "n": len(mu),
                "mean": mu.mean(),
                "mean_error": mu.sem(),
                "deviation": mu.std(),
                "least": mu.min(),
                **{name: mu.quantile(share) for name, share in QUANTILES.items()},
                "largest": mu.max(),
                "mean_interval_s": slips["onset_s"].diff().mean(),
            }
        )
    return pd.DataFrame(rows)
