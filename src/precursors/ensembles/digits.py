"""The paper's numbers over all values that are printed alike: mu_s = 0.70 is anything from 0.695 to 0.705."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd

from precursors.analysis.run_statistics import median_interval, share_interval
from precursors.ensembles.spread import QUANTILES, UNCHANGED
from precursors.ensembles.study import Study, stack

# Half a unit of the last digit that the paper prints (Sect. 4 and the captions of Figs. 10-12), in SI units.
# F_Z only scales all forces. S and L enter through k alone, whose last digit is that of E.
HALF_A_DIGIT = {
    "mu_s": 0.005,
    "mu_k": 0.005,
    "drive_stiffness": 0.05e6,
    "drive_velocity": 0.05e-3,
    "slider_mass": 0.0005,
    "youngs_modulus": 0.05e9,
    "theta": 0.0005,
}
THETA_DIGITS = 3
# Two friction coefficients agree if they differ by no more than a unit of the last digit of 0.49.
AGREE = 0.01


def digits_study(
    sliders: Mapping[str, Mapping[str, Any]], duration: float, settings: Mapping[str, Any]
) -> Study:
    """Sliders printed alike. Draw i is the same slider in each scene, draw 0 is the scene as it is."""
    random = np.random.default_rng(settings["seed"])
    changes = {key: half * random.uniform(-1, 1, settings["draws"]) for key, half in HALF_A_DIGIT.items()}
    blocks = []
    for scene, slider in sliders.items():
        printed = {**slider, "theta": round(slider["theta"], THETA_DIGITS)}
        changed = {key: np.append(slider[key], printed[key] + change) for key, change in changes.items()}
        # A slower drive takes longer to the same load.
        slowest = 1 - HALF_A_DIGIT["drive_velocity"] / slider["drive_velocity"]
        labels = {"scene": scene, "draw": np.arange(settings["draws"] + 1), "duration": duration / slowest}
        blocks.append({**slider, **changed, **labels})
    return Study(stack(blocks), seed=settings["seed"])


def digits_table(members: pd.DataFrame) -> pd.DataFrame:
    """How far each number is settled by the printed digits.

    Returns
    -------
    DataFrame
        One row per scene and quantity: its value for the scene as it is, quantiles, the interval of the
        median, and the probability (with its interval) that it is unchanged (see `spread.UNCHANGED`). mu_sapp
        has rows more: scene "all, same slider" and "all, any slider" with the probability that the three
        scenes agree within `AGREE`, and the quantiles of their range.
    """
    draws = members[members["draw"] > 0]
    rows = []
    for scene, runs in draws.groupby("scene", sort=False):
        alone = members[(members["scene"] == scene) & (members["draw"] == 0)].iloc[0]
        for quantity, tolerance in UNCHANGED.items():
            if quantity == "time_s":  # it is that of the drive, whose speed has one digit
                continue
            same = (runs[quantity] - alone[quantity]).abs() <= tolerance
            value = {"scene": scene, "quantity": quantity, "value": alone[quantity]}
            rows.append(value | _probability(runs[quantity], same))
    friction = draws.pivot_table(index="draw", columns="scene", values="mu_sapp", sort=False, dropna=False)
    # Shifted columns are sliders drawn apart from each other.
    apart = pd.DataFrame({scene: np.roll(friction[scene], i) for i, scene in enumerate(friction)})
    for name, table in (("all, same slider", friction), ("all, any slider", apart)):
        span = table.max(axis=1, skipna=False) - table.min(axis=1, skipna=False)
        value = {"scene": name, "quantity": "range of mu_sapp", "value": np.nan}
        rows.append(value | _probability(span, span <= AGREE))
    return pd.DataFrame(rows)


def _probability(values: pd.Series, hits: pd.Series) -> dict[str, Any]:
    known = values.dropna()
    median_low, median_high = median_interval(known)
    low, high = share_interval(int(hits.sum()), len(hits))
    return {
        **{name: float(known.quantile(share)) for name, share in QUANTILES.items()},
        "q50_low": median_low,
        "q50_high": median_high,
        "probability": hits.mean(),
        "probability_low": low,
        "probability_high": high,
        "n": len(hits),
    }
