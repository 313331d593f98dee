"""The window of theta: a scene at evenly spaced values of theta that are near its own."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np
import pandas as pd

from precursors.analysis.run_statistics import statistics
from precursors.ensembles.noise import TOLERANCES
from precursors.ensembles.study import Study, gather, stack


def theta_window_study(
    sliders: Mapping[str, Mapping[str, Any]], duration: float, settings: Mapping[str, Any]
) -> Study:
    """Each scene as it is (point 0), and at `points` values of theta up to `window` from its own."""
    sweep = np.linspace(-settings["window"], settings["window"], settings["points"])
    change = np.append(0.0, sweep)
    blocks = []
    for scene, slider in sliders.items():
        theta = np.clip(slider["theta"] + change, -1.0, 1.0)
        blocks.append(
            {**slider, "theta": theta, "scene": scene, "point": np.arange(len(theta)), "duration": duration}
        )
    return Study(stack(blocks))


def theta_window_tables(chunks: Iterable[pd.DataFrame]) -> dict[str, pd.DataFrame]:
    """The tables of the study, by file name."""
    members = gather(chunks)
    return {"theta_window_members": members, "theta_window": theta_window_table(members)}


def theta_window_table(members: pd.DataFrame) -> pd.DataFrame:
    """One row per scene and quantity: its value at the scene's theta, and statistics over the window.

    share_same is the share of the window where the number is that of the scene to `TOLERANCES`.
    """
    rows = []
    for scene, of_scene in members.groupby("scene", sort=False):
        alone, window = of_scene[of_scene["point"] == 0].iloc[0], of_scene[of_scene["point"] > 0]
        for quantity, tolerance in TOLERANCES.items():
            same = (window[quantity] - alone[quantity]).abs() <= tolerance
            number = {"scene": scene, "theta": alone["theta"], "quantity": quantity}
            number |= {"at_theta": alone[quantity], "share_same": same.mean()}
            rows.append(number | statistics(window[quantity]))
    return pd.DataFrame(rows)
