"""Noise: the numbers of a scene when every normal load is known to a tenth of a per
cent only."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from itertools import combinations
from typing import Any

import numpy as np
import pandas as pd

from precursors.analysis.run_statistics import compared, median_difference, statistics
from precursors.ensembles.study import NOISE, Study, gather, stack

# Two numbers are the same if they differ by no more than this: friction coefficients by
# a unit of the last digit of the paper's 0.49, times by what can be read from the axis
# of Figs. 10-12.
TOLERANCES = {
    "mu_sapp": 0.01,
    "events_counted": 0.0,
    "events_to_global_slip": 0.0,
    "time_s": 0.05,
}


def noise_study(
    sliders: Mapping[str, Mapping[str, Any]],
    duration: float,
    settings: Mapping[str, Any],
) -> Study:
    """Runs of each scene with noise in the normal loads; draw 0 has none."""
    draw = np.arange(settings["runs"] + 1)
    noise = {
        "draw": draw,
        "load_noise": np.where(draw == 0, 0.0, NOISE),
        "duration": duration,
    }
    blocks = [
        {**slider, **noise, "scene": scene, "group": group}
        for group, (scene, slider) in enumerate(sliders.items())
    ]
    return Study(stack(blocks), seed=settings["seed"])


def noise_tables(chunks: Iterable[pd.DataFrame]) -> dict[str, pd.DataFrame]:
    """The tables of the study, by file name."""
    members = gather(chunks)
    return {
        "noise_members": members,
        "noise": noise_table(members),
        "noise_differences": differences_table(members),
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
        many of these have a global slip; `statistics` of those.
    """
    rows = []
    for values, at_point in members.groupby(list(point), sort=False):
        alone = at_point[at_point["draw"] == 0]
        runs = with_noise(at_point)
        number = {"runs": int((at_point["draw"] > 0).sum()), "reached": len(runs)}
        for quantity in quantities:
            labels = dict(zip(point, values, strict=True)) | {"quantity": quantity}
            labels["without_noise"] = alone[quantity].item()
            rows.append(labels | number | statistics(runs[quantity]))
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
            pair = {"quantity": quantity, "scene": scene, "theta": theta}
            pair |= {"other": other, "other_theta": other_theta}
            difference = values[scene].median() - values[other].median()
            found = {
                "difference": difference,
                "low": low,
                "high": high,
                "tolerance": tolerance,
            }
            rows.append(pair | found | {"verdict": compared(low, high, tolerance)})
    return pd.DataFrame(rows)
