"""Noise: the numbers of a scene when every normal load is known to a tenth of a per
cent only."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from itertools import combinations
from typing import Any

import numpy as np
import pandas as pd

from precursors.analysis.run_statistics import (
    NOISE,
    compared,
    median_difference,
    nine_tenths,
)
from precursors.ensembles.study import Study, gather, stack
from precursors.model import printed

# Two numbers are the same if they differ by no more than this: friction coefficients by
# a unit of the last digit of the paper's 0.49, times by what can be read from the axis
# of Figs. 10-12.
TOLERANCES = {
    "mu_sapp": printed.LAST_DIGIT,
    "events_counted": 0.0,
    "events_to_global_slip": 0.0,
    "time_s": 0.05,
}
# Other noise, with so many runs for one with NOISE: the difference of two mu_sapp grows
# with it.
AMPLITUDES = (1e-4, 1e-2, 3e-2)
FEWER = 5


def draws(runs: int) -> dict[str, Any]:
    """Columns of an ensemble: as many runs with noise, after draw 0 without it."""
    draw = np.arange(runs + 1)
    return {"draw": draw, "load_noise": np.where(draw == 0, 0.0, NOISE)}


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


def noise_table(
    members: pd.DataFrame,
    point: Sequence[str] = ("scene", "theta"),
    quantities: Iterable[str] = TOLERANCES,
) -> pd.DataFrame:
    """Distribution of each number over the noise.

    Returns
    -------
    DataFrame
        One row per point and quantity: without_noise; runs with noise; reached, how
        many of these have a global slip; `nine_tenths` of those.
    """
    rows = []
    for values, at_point in members.groupby(list(point), sort=False):
        alone = at_point[at_point["draw"] == 0]
        runs = with_noise(at_point)
        number = {"runs": int((at_point["draw"] > 0).sum()), "reached": len(runs)}
        for quantity in quantities:
            labels = dict(zip(point, values, strict=True)) | {"quantity": quantity}
            labels["without_noise"] = alone[quantity].item()
            rows.append(labels | number | nine_tenths(runs[quantity]))
    return pd.DataFrame(rows)


def with_noise(members: pd.DataFrame) -> pd.DataFrame:
    """The runs with noise that have a global slip."""
    return members[(members["draw"] > 0) & members["reached"]]


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
