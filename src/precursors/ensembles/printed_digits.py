"""The paper's numbers over all values that are printed alike: mu_s = 0.70 is anything
from 0.695 to 0.705."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np
import pandas as pd

from precursors.analysis.run_statistics import QUANTILES, share_interval
from precursors.ensembles.noise import TOLERANCES
from precursors.ensembles.study import Study, gather, stack

# Half a unit of the last digit that the paper prints (Sect. 4 and the captions of Figs.
# 10-12), in SI units. F_Z only scales all forces. S and L enter through k alone, whose
# last digit is that of E.
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
# A number is robust if this share of the sliders has it, and fragile if fewer have.
ENOUGH = 0.95
ALL = "all"
# Times are those of the drive, whose speed is printed with one digit.
QUANTITIES = ("mu_sapp", "events_counted", "events_to_global_slip")
ENDS = ("q05", "q50", "q95")


def digits_study(
    sliders: Mapping[str, Mapping[str, Any]],
    duration: float,
    settings: Mapping[str, Any],
) -> Study:
    """Sliders printed alike. Draw i is the same slider in each scene, draw 0 is the
    scene as it is."""
    random = np.random.default_rng(settings["seed"])
    changes = {
        key: half * random.uniform(-1, 1, settings["draws"])
        for key, half in HALF_A_DIGIT.items()
    }
    blocks = []
    for scene, slider in sliders.items():
        printed = {**slider, "theta": round(slider["theta"], THETA_DIGITS)}
        changed = {
            key: np.append(slider[key], printed[key] + change)
            for key, change in changes.items()
        }
        # A slower drive takes longer to the same load.
        slowest = 1 - HALF_A_DIGIT["drive_velocity"] / slider["drive_velocity"]
        labels = {
            "scene": scene,
            "draw": np.arange(settings["draws"] + 1),
            "duration": duration / slowest,
        }
        blocks.append({**slider, **changed, **labels})
    return Study(stack(blocks), seed=settings["seed"])


def digits_tables(
    chunks: Iterable[pd.DataFrame], paper: Mapping[str, Mapping[str, float]]
) -> dict[str, pd.DataFrame]:
    """The tables of the study, by file name."""
    members = gather(chunks)
    return {"digits_members": members, "digits": digits_table(members, paper)}


def digits_table(
    members: pd.DataFrame, paper: Mapping[str, Mapping[str, float]]
) -> pd.DataFrame:
    """How far the printed digits settle each number.

    `paper` has events_counted and mu_sapp of each scene, as far as the paper prints
    them.

    Returns
    -------
    DataFrame
        One row per scene, quantity and question. as_in_run: is the number that of the
        scene as it is? as_printed: is it the paper's? k of n sliders, their share with
        its interval low to high, the class by `ENOUGH`: robust, fragile or undecided,
        and q05, q50, q95, the 5, 50 and 95 % of the numbers drawn. Scene all: are the
        three mu_sapp of a slider the same to a unit of the last digit (same_mu_sapp),
        and are all six numbers the paper's (all_six)?
    """
    draws = members[members["draw"] > 0]
    found: list[tuple[Any, str, str, float, pd.Series]] = []
    for scene, runs in draws.groupby("scene", sort=False):
        alone = members[(members["scene"] == scene) & (members["draw"] == 0)].iloc[0]
        for quantity in QUANTITIES:
            drawn = runs.set_index("draw")[quantity]
            values = {
                "as_in_run": alone[quantity],
                "as_printed": paper[str(scene)].get(quantity),
            }
            for question, value in values.items():
                if value is not None:
                    agree = agrees(drawn, value, TOLERANCES[quantity])
                    found.append((scene, quantity, question, value, agree))
    six = [agree for _, _, question, _, agree in found if question == "as_printed"]
    friction = draws.pivot_table(
        index="draw", columns="scene", values="mu_sapp", dropna=False
    )
    span = friction.max(axis=1, skipna=False) - friction.min(axis=1, skipna=False)
    same = agrees(span, 0.0, TOLERANCES["mu_sapp"])
    found.append((ALL, "mu_sapp", "same_mu_sapp", span.median(), same))
    if six:
        found.append(
            (ALL, ALL, "all_six", len(six), pd.concat(six, axis=1).all(axis=1))
        )
    table = pd.DataFrame(
        {"scene": scene, "quantity": quantity, "question": question, "value": value}
        | share_row(agree)
        for scene, quantity, question, value, agree in found
    )
    numbers = draws.melt("scene", QUANTITIES, "quantity").groupby(["scene", "quantity"])
    ends = {name: numbers["value"].quantile(QUANTILES[name]) for name in ENDS}
    return table.join(pd.DataFrame(ends), on=["scene", "quantity"])


def agrees(values: pd.Series, value: float, tolerance: float) -> pd.Series:
    """Where values are a value to a tolerance; NaN, a run without a global slip, is
    not."""
    return (values - value).abs() <= tolerance


def share_row(hits: pd.Series) -> dict[str, Any]:
    """How many sliders have a number, their share with its interval, and the class of
    the number."""
    k = int(hits.sum())
    n = len(hits)
    low, high = share_interval(k, n)
    name = "robust" if low >= ENOUGH else "fragile" if high < ENOUGH else "undecided"
    return {"k": k, "n": n, "share": k / n, "low": low, "high": high, "class": name}
