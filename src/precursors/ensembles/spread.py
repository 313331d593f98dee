"""Spread: how far counts and mu_sapp of a scene change with values that nobody knows exactly.

Four questions in one study: noise in the normal loads; theta swept through a window; noise in the initial
positions; and the parameters one by one.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
import pandas as pd

from precursors.analysis.run_statistics import share_interval
from precursors.ensembles.study import Study, stack
from precursors.model.chain import FloatArray

QUESTIONS = ("loads", "theta", "start", "parameters")
# Perturbations that change no single parameter: the scene as it is, and the sweep of theta.
UNPERTURBED, SWEEP = "none", "theta, evenly spaced"
# What is changed for each parameter of the model; k enters through E alone (Eq. 10).
PARAMETERS = {
    "mu_s": "mu_s",
    "mu_k": "mu_k",
    "K": "drive_stiffness",
    "V": "drive_velocity",
    "k": "youngs_modulus",
    "theta": "theta",
}
# Random streams are numbered question by question.
STREAMS_PER_QUESTION = 100_000

# A number is unchanged if it is off by no more than this: counts not at all, mu_sapp by half a unit of the
# last digit that the paper prints (0.49), times by what can be read from the axis of Figs. 10-12.
UNCHANGED = {"events_counted": 0.0, "n_events": 0.0, "mu_sapp": 0.005, "time_s": 0.05}
QUANTILES = {"least": 0.0, "q05": 0.05, "q25": 0.25, "q50": 0.5, "q75": 0.75, "q95": 0.95, "largest": 1.0}

# The rule of robustness.csv: an ensemble keeps a number that so large a share of its members has unchanged.
ENOUGH = 0.95
# What a laboratory knows of its parameters and loads.
KNOWN = 1e-2
# Half a unit of the third digit, the finest that the paper prints (theta = 0.833).
ROUNDING = 5e-4
_KEPT = f"unchanged in {ENOUGH:.0%} of every ensemble with changes up to"
RULES = {
    "robust": f"{_KEPT} {KNOWN:g}, which is what an experiment knows of its values",
    "sensitive": f"{_KEPT} {ROUNDING:g}, which is half a unit of the third digit, but not up to {KNOWN:g}",
    "fragile": f"changed in more than {1 - ENOUGH:.0%} of some ensemble with changes up to {ROUNDING:g}, "
    "which is half a unit of the third digit, the finest that the paper prints",
}


def spread_study(
    sliders: Mapping[str, Mapping[str, Any]], duration: float, settings: Mapping[str, Any]
) -> Study:
    """The study of the four questions.

    Each scene has one member that is not perturbed, and ensembles of members told apart by `draw`. A size is
    the largest relative change, reached with both signs; that of theta is absolute, and that of the initial
    positions relative to mu_s F_Z / (N k). Changes are uniform between the two.

    Parameters
    ----------
    sliders : mapping
        Scene to arguments of `Chain.from_slider`.
    duration : float
        Time limit of a run [s].
    settings : mapping
        Section `spread` of the configuration.
    """
    nothing = {"perturbation": UNPERTURBED, "size": 0.0, "draw": np.arange(1)}
    blocks = []
    for i, question in enumerate(QUESTIONS):
        group = STREAMS_PER_QUESTION * i
        for scene, slider in sliders.items():
            common = {"duration": duration, "scene": scene, "question": question}
            common |= {"load_noise": 0.0, "start_noise": 0.0}
            for ensemble in (nothing, *_ensembles(question, settings)):
                block = {**slider, **common, **ensemble, "group": group}
                blocks.append(block | _changed_parameter(block, settings["seed"]))
                group += 1
    return Study(stack(blocks), seed=settings["seed"])


def _ensembles(question: str, settings: Mapping[str, Any]) -> Iterator[dict[str, Any]]:
    """What the ensembles of a question change."""
    draw = np.arange(settings["members"])
    if question == "loads":
        for size in settings["loads"]:
            yield {"perturbation": "normal loads", "size": size, "load_noise": size, "draw": draw}
    elif question == "start":
        for size in settings["start"]:
            yield {"perturbation": "initial positions", "size": size, "start_noise": size, "draw": draw}
    elif question == "theta":
        sweep = np.arange(settings["theta"]["points"])
        yield {"perturbation": SWEEP, "size": settings["theta"]["window"], "draw": sweep}
    else:
        for name in PARAMETERS:
            for size in settings["parameters"]:
                yield {"perturbation": name, "size": size, "draw": draw}


def _changed_parameter(block: Mapping[str, Any], seed: int) -> dict[str, FloatArray]:
    """The changed values of the parameter that an ensemble changes, if it is one."""
    size, n = block["size"], len(block["draw"])
    if block["perturbation"] == SWEEP:
        return {"theta": _change("theta", block["theta"], np.linspace(-size, size, n))}
    if block["perturbation"] in PARAMETERS:
        key = PARAMETERS[block["perturbation"]]
        stream = np.random.default_rng(np.random.SeedSequence(seed, spawn_key=(block["group"],)))
        return {key: _change(key, block[key], stream.uniform(-size, size, n))}
    return {}


def _change(key: str, value: float, change: FloatArray) -> FloatArray:
    return np.clip(value + change, -1.0, 1.0) if key == "theta" else value * (1.0 + change)


def spread_table(members: pd.DataFrame) -> pd.DataFrame:
    """What each ensemble makes of each number.

    Parameters
    ----------
    members : DataFrame
        The gathered study.

    Returns
    -------
    DataFrame
        One row per scene, question, ensemble and quantity: the value without perturbation, mean and
        quantiles; the share of members that have it unchanged (see `UNCHANGED`) and the interval of this
        probability, share_low to share_high; the share that met a global
        slip, and the number of members n.
    """
    keys = ["scene", "question", "perturbation", "size"]
    alone = members[members["perturbation"] == UNPERTURBED].drop_duplicates("scene")
    unperturbed = alone.set_index("scene").to_dict("index")
    ensembles = members[members["perturbation"] != UNPERTURBED].groupby(keys, sort=False)
    return pd.DataFrame(
        [
            dict(zip(keys, key, strict=True))
            | {"quantity": quantity}
            | _distribution(ensemble[quantity].to_numpy(float), unperturbed[key[0]][quantity], tolerance)
            | {"share_reached": ensemble["reached"].mean(), "n": len(ensemble)}
            for key, ensemble in ensembles
            for quantity, tolerance in UNCHANGED.items()
        ]
    )


def _distribution(values: FloatArray, unperturbed: float, tolerance: float) -> dict[str, float]:
    """What an ensemble makes of a number; a member without global slip has it changed."""
    known = values[~np.isnan(values)]
    unchanged = np.abs(values - unperturbed) <= tolerance
    low, high = share_interval(int(unchanged.sum()), len(values))
    quantiles = np.quantile(known, list(QUANTILES.values())) if len(known) else [np.nan] * len(QUANTILES)
    return {
        "unperturbed": unperturbed,
        "mean": np.mean(known) if len(known) else np.nan,
        **dict(zip(QUANTILES, quantiles, strict=True)),
        "share_unchanged": float(np.mean(unchanged)),
        "share_low": low,
        "share_high": high,
    }


def robustness_table(spread: pd.DataFrame) -> pd.DataFrame:
    """Robust, sensitive or fragile: each number of each scene, by the rule that `RULES` puts into words.

    Returns
    -------
    DataFrame
        One row per scene and quantity: class; changes_at, the smallest size at which it changes in more than
        5 % of an ensemble (NaN if it never does), with the perturbation and the share_unchanged of the
        ensemble that changes most at that size, or at any; the rule.
    """
    rows = []
    for (scene, quantity), ensembles in spread.groupby(["scene", "quantity"], sort=False):
        changes_at = ensembles.loc[ensembles["share_unchanged"] < ENOUGH, "size"].min()
        at_that_size = ensembles[ensembles["size"] == changes_at] if changes_at > 0 else ensembles
        weakest = at_that_size.nsmallest(1, "share_unchanged").iloc[0]
        name = classify(changes_at)
        rows.append(
            {
                "scene": scene,
                "quantity": quantity,
                "class": name,
                "changes_at": changes_at,
                "perturbation": weakest["perturbation"],
                "share_unchanged": weakest["share_unchanged"],
                "share_low": weakest["share_low"],
                "share_high": weakest["share_high"],
                "rule": RULES[name],
            }
        )
    return pd.DataFrame(rows)


def classify(changes_at: float) -> str:
    """Class of a number by the smallest size of change that it does not survive (NaN if it survives all)."""
    if changes_at <= ROUNDING:
        return "fragile"
    return "sensitive" if changes_at <= KNOWN else "robust"
