"""Noise: the numbers of a scene when every normal load is known to a tenth of a per
cent only."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from itertools import combinations
from typing import Any

import numpy as np
import pandas as pd

from maegawa2010.studies.members import (
    TOLERANCES,
    Study,
    draws,
    gather,
    noise_table,
    stack,
    with_noise,
)
from maegawa2010.support.run_statistics import (
    NOISE,
    compared,
    median_difference,
)

# Other noise, with so many runs for one with NOISE: the difference of two mu_sapp grows
# with it.
AMPLITUDES = (1e-4, 1e-2, 3e-2)
FEWER = 5


def noise_study(
    sliders: Mapping[str, Mapping[str, Any]],
    duration: float,
    settings: Mapping[str, Any],
) -> Study:
    """Runs of each scene with noise in the normal loads; draw 0 has none.

    Noise of another amplitude comes after them: the same draws, made smaller or larger.
    """
    few = np.arange(1, 1 + settings["runs"] // FEWER)
    noises = [draws(settings["runs"])]
    noises += [{"draw": few, "load_noise": amplitude} for amplitude in AMPLITUDES]
    blocks = [
        {**slider, **noise, "duration": duration, "scene": scene, "group": group}
        for noise in noises
        for group, (scene, slider) in enumerate(sliders.items())
    ]
    return Study(stack(blocks), seed=settings["seed"])


def noise_tables(chunks: Iterable[pd.DataFrame]) -> dict[str, pd.DataFrame]:
    """The tables of the study, by file name."""
    gathered = gather(chunks)
    members = gathered[gathered["load_noise"].isin((0.0, NOISE))]
    return {
        "noise_members": members,
        "noise": noise_table(members),
        "noise_differences": differences_table(members),
        "noise_amplitudes": amplitudes_table(gathered),
    }


def differences_table(members: pd.DataFrame) -> pd.DataFrame:
    """Whether two loadings have the same median.

    Returns
    -------
    DataFrame
        One row per quantity and pair of scenes: difference of the medians, scene less
        other, with an interval low to high that holds it in at least 95 % of cases;
        tolerance; verdict of `compared`.
    """
    runs = with_noise(members)
    scenes = runs.drop_duplicates("scene").set_index("scene")["theta"].items()
    pairs = list(combinations(scenes, 2))
    rows = []
    for quantity, tolerance in TOLERANCES.items():
        values: dict[Any, pd.Series] = dict(
            iter(runs.groupby("scene", sort=False)[quantity])
        )
        for (other, other_theta), (scene, theta) in pairs:
            low, high = median_difference(values[scene], values[other])
            row = {
                "quantity": quantity,
                "scene": scene,
                "theta": theta,
                "other": other,
                "other_theta": other_theta,
                "difference": values[scene].median() - values[other].median(),
                "low": low,
                "high": high,
                "tolerance": tolerance,
                "verdict": compared(low, high, tolerance),
            }
            rows.append(row)
    return pd.DataFrame(rows)


def amplitudes_table(members: pd.DataFrame) -> pd.DataFrame:
    """Differences of mu_sapp, as in `differences_table`, for each amplitude of the
    noise."""
    tables = {
        amplitude: differences_table(runs).query("quantity == 'mu_sapp'")
        for amplitude, runs in with_noise(members).groupby("load_noise")
    }
    return pd.concat(tables, names=["load_noise"]).reset_index("load_noise")
