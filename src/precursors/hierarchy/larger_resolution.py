"""Convergence with N of the larger models: which numbers still depend on how finely the slider is cut?"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np
import pandas as pd
from scipy.stats import kruskal

from precursors.analysis.run_statistics import median_interval, statistics
from precursors.hierarchy.larger import LargerChain
from precursors.hierarchy.models import Motion, events_counted, first_global_slip, move
from precursors.model.chain import Chain, parse_theta

# What makes a model, and how the tables call it.
VALUES = {
    "relaxation_time": "viscous_time_s",
    "viscosity": "viscosity_N_s_per_m",
    "interface_stiffness": "interface_stiffness_N_per_m",
}
POINT = ["model", "theta", *VALUES.values(), "n_blocks"]


def run_models(slider: Mapping[str, Any], settings: Mapping[str, Any]) -> pd.DataFrame:
    """Run chains of more and more blocks, with the additions of each model, up to the first global slip.

    The first run of each point (draw 0) has the normal loads of Eq. 7. In the others each of them is changed
    by up to the relative size `noise`, at random, and by the same amounts in every model.

    Parameters
    ----------
    slider : mapping
        Arguments of `Chain.from_slider`.
    settings : mapping
        Settings of the study in the configuration: theta, n_blocks, noise, runs (of each point), seed,
        and models. A model has any of relaxation_time t_v [s] (dashpots eta = k t_v, the stiffer the more
        blocks), viscosity eta [N s/m], interface_stiffness K_t [N/m], and most_blocks, its largest N.

    Returns
    -------
    DataFrame
        One row per run and quantity that the run has: `POINT`, draw, quantity, value. The quantities are
        events_counted, mu_sapp, time_s (onset of the first global slip [s]) and front_speed_m_per_s (its mean
        speed from block 1 to block N [m/s]).
    """
    rows = []
    for name, values in settings["models"].items():
        point = {"model": name, "theta": parse_theta(settings["theta"])}
        point |= {column: values.get(key, 0.0) for key, column in VALUES.items()}
        for n in settings["n_blocks"]:
            if n > values.get("most_blocks", n):
                continue
            chain = Chain.from_slider(**{**slider, "theta": settings["theta"], "n_blocks": n})
            for draw in range(settings["runs"]):
                motion = move(with_additions(with_noise(chain, draw, settings), values))
                for quantity, value in numbers(motion, chain.length).items():
                    rows.append(point | {"n_blocks": n, "draw": draw, "quantity": quantity, "value": value})
    return pd.DataFrame(rows).dropna(subset="value")


def loadings_table(
    slider: Mapping[str, Any], settings: Mapping[str, Any], loadings: Mapping[str, Any]
) -> pd.DataFrame:
    """Whether mu_sapp of a model is the same for all distributions of the normal load, the paper's question.

    Parameters
    ----------
    slider, settings : mapping
        As in `run_models`.
    loadings : mapping
        What differs from the settings: theta (a list), n_blocks (a number), runs (of each theta), models
        (their names).

    Returns
    -------
    DataFrame
        One row per model: n_blocks; least and largest, the medians of mu_sapp for the loadings, with the
        95 % interval of each (least_low ...); p, the probability of medians as far apart if mu_sapp had the
        same distribution for all loadings (test of Kruskal and Wallis); and runs.

    Raises
    ------
    ValueError
        If a model is not among those of the settings.
    """
    if unknown := set(loadings["models"]) - set(settings["models"]):
        raise ValueError(
            f"models of loadings must be names of models of resolution, but are {sorted(unknown)}"
        )
    models = {name: settings["models"][name] for name in loadings["models"]}
    changes = {"models": models, "n_blocks": [loadings["n_blocks"]], "runs": loadings["runs"]}
    runs = pd.concat(
        run_models(slider, {**settings, **changes, "theta": theta}) for theta in loadings["theta"]
    )
    rows = []
    for model, of_model in runs[runs["quantity"] == "mu_sapp"].groupby("model", sort=False):
        samples = [values for _, values in of_model.groupby("theta")["value"]]
        least, *_, largest = sorted(samples, key=np.median)
        row = {"model": model, "n_blocks": loadings["n_blocks"]}
        for name, values in (("least", least), ("largest", largest)):
            low, high = median_interval(values)
            row |= {name: values.median(), f"{name}_low": low, f"{name}_high": high}
        rows.append(row | {"p": kruskal(*samples).pvalue, "runs": min(map(len, samples))})
    return pd.DataFrame(rows)


def with_noise(chain: Chain, draw: int, settings: Mapping[str, Any]) -> Chain:
    """The chain with noise in its normal loads; draw 0 has none."""
    if draw == 0:
        return chain
    random = np.random.default_rng([settings["seed"], chain.n_blocks, draw])
    change = settings["noise"] * random.uniform(-1.0, 1.0, chain.n_blocks)
    return replace(chain, weights=chain.weights * (1.0 + change))


def with_additions(chain: Chain, values: Mapping[str, Any]) -> Chain | LargerChain:
    """The chain with the additions of a model; one without any is the paper's."""
    viscosity = values.get("viscosity", 0.0) + values.get("relaxation_time", 0.0) * chain.stiffness
    stiffness = values.get("interface_stiffness", 0.0)
    return LargerChain(chain, viscosity, stiffness) if viscosity or stiffness else chain


def numbers(motion: Motion, length: float) -> dict[str, float]:
    """What is kept of a run; `length` [m] is that of the contact."""
    onset = first_global_slip(motion)["onset"]
    distance = length * (motion.n_blocks - 1) / motion.n_blocks
    crossing = motion.front_arrival - onset  # 0 if the event begins at block N, as it may on springs
    return {
        "events_counted": events_counted(motion),
        "mu_sapp": motion.mu_sapp,
        "time_s": onset,
        "front_speed_m_per_s": distance / crossing if crossing > 0 else np.nan,
    }


def resolution_models_table(runs: pd.DataFrame) -> pd.DataFrame:
    """Statistics over the runs.

    Returns
    -------
    DataFrame
        One row per model, theta, n_blocks and quantity, with the values of the model: the number
        without_noise, and what `statistics` has of all runs.
    """
    rows = []
    for (*point, quantity), of_point in runs.groupby([*POINT, "quantity"], sort=False):
        without_noise = of_point.loc[of_point["draw"] == 0, "value"]
        row = {**dict(zip(POINT, point, strict=True)), "quantity": quantity}
        row["without_noise"] = without_noise.iloc[0] if len(without_noise) else np.nan
        rows.append(row | statistics(of_point["value"]))
    return pd.DataFrame(rows)
