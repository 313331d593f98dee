"""Slip that does not end: how often, against N, a uniformly loaded chain never has a global slip.

Instead a short pulse travels along the chain, and is reflected at both ends. A few blocks slide at a time.
The load stays at mu_k F_Z. Self-healing slip pulses of faults are alike (Heaton 1990; Perrin, Rice and Zheng
1995).
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd

from precursors.analysis.run_statistics import share_interval
from precursors.ensembles.event_law import NOISE, added_load
from precursors.ensembles.study import Study, stack
from precursors.model.chain import Chain

# A run ends when the drive has added so many times what it adds until the friction is mu_k w_i everywhere.
# First global slips of large chains come at 1.00 to 1.04 times this load.
MOST_LOAD = 1.15


def endless_study(slider: Mapping[str, Any], settings: Mapping[str, Any]) -> Study:
    """Chains of many blocks at theta = 0, with noise in the normal loads."""
    blocks = []
    for group, (n, runs) in enumerate(zip(settings["n_blocks"], settings["runs"], strict=True)):
        member = {"theta": 0.0, **slider, "n_blocks": n}
        chain = Chain.from_slider(**member)
        duration = MOST_LOAD * added_load(chain) / chain.loading_rate
        draws = {"load_noise": NOISE, "group": group, "draw": np.arange(runs), "duration": duration}
        blocks.append(member | draws)
    return Study(stack(blocks), longest_slip=settings["longest_slip"], seed=settings["seed"])


def endless_table(members: pd.DataFrame, length: float) -> pd.DataFrame:
    """How often slip does not end, and what then travels along the chain.

    Returns
    -------
    DataFrame
        One row per number of blocks: runs; endless, those without a global slip that end while blocks slide;
        their share with its interval; the means of their pulse_blocks, length [m], speed [m/s] and F_X/F_Z,
        and pulse_time_s, the shortest time [s] that such a slip has lasted (NaN where there are none).
        earlier: the share of runs, with its interval, in which every block slid in an event before all slid
        at once.
    """
    rows = []
    for n, runs in members.groupby("n_blocks"):
        endless = runs[~runs["reached"] & runs["pulse_blocks"].notna()]
        earlier = (runs["sliding_each"] > 0) & (runs["sliding_each"] < n)
        low, high = share_interval(len(endless), len(runs))
        earlier_low, earlier_high = share_interval(int(earlier.sum()), len(runs))
        rows.append(
            {
                "n_blocks": n,
                "runs": len(runs),
                "endless": len(endless),
                "share": len(endless) / len(runs),
                "share_low": low,
                "share_high": high,
                "pulse_blocks": endless["pulse_blocks"].mean(),
                "pulse_length_m": (endless["pulse_blocks"] / endless["n_blocks"]).mean() * length,
                "pulse_speed_m_per_s": endless["pulse_speed_m_per_s"].mean(),
                "pulse_mu": endless["pulse_mu"].mean(),
                "pulse_time_s": endless["pulse_time_s"].min(),
                "earlier": earlier.mean(),
                "earlier_low": earlier_low,
                "earlier_high": earlier_high,
            }
        )
    return pd.DataFrame(rows)
