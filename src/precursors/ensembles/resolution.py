"""Resolution: which numbers of the paper depend on how finely the slider is cut into blocks."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike

from precursors.analysis.run_statistics import statistics
from precursors.ensembles.study import Study, stack
from precursors.model.chain import FloatArray

QUANTITIES = ("events_kept", "mu_sapp", "time_s", "front_speed_m_per_s")
# The law with which each number is carried on to infinite N.
LAWS = {
    "events_kept": "c N^p",
    "mu_sapp": "a + b/N",
    "time_s": "a + b/N",
    "front_speed_m_per_s": "a + b/N",
}


def resolution_study(
    sliders: Mapping[str, Mapping[str, Any]], duration: float, settings: Mapping[str, Any]
) -> Study:
    """Chains of more and more blocks with the loading of some scenes.

    The first member of each chain has the normal loads of Eq. 7, the others have them with noise.

    Parameters
    ----------
    sliders : mapping
        Scene to arguments of `Chain.from_slider`.
    duration : float
        Time limit of a run [s].
    settings : mapping
        Section `resolution` of the configuration.
    """
    blocks: list[dict[str, Any]] = []
    for scene, slider in sliders.items():
        for n_blocks, n_runs in zip(settings["n_blocks"], settings["runs"], strict=True):
            draw = np.arange(n_runs)
            noise = np.where(draw == 0, 0.0, settings["noise"])
            block = {**slider, "n_blocks": n_blocks, "duration": duration, "scene": scene}
            blocks.append(block | {"load_noise": noise, "draw": draw, "group": len(blocks)})
    return Study(stack(blocks), seed=settings["seed"])


def estimated_mu_sapp(n_blocks: ArrayLike, mu_s: float, mu_k: float) -> FloatArray:
    """Estimate mu_k + 2 (mu_s - mu_k) / N of the apparent static friction coefficient [1].

    The load is the kinetic friction of all blocks, and above it the drop of the load when one block slides.
    """
    return mu_k + 2.0 * (mu_s - mu_k) / np.asarray(n_blocks, float)


def front_speed(members: pd.DataFrame, length: float) -> pd.Series:
    """Mean speed of the front of the first global slip from block 1 to block N [m/s]; NaN without one.

    Parameters
    ----------
    members : DataFrame
        Columns n_blocks and crossing_time_s.
    length : float
        Length L of the contact [m].
    """
    distance = length * (members["n_blocks"] - 1) / members["n_blocks"]
    return distance / members["crossing_time_s"].where(members["crossing_time_s"] > 0)


def resolution_table(members: pd.DataFrame, length: float) -> pd.DataFrame:
    """Statistics of each number over the runs with the same scene and number of blocks.

    Parameters
    ----------
    members : DataFrame
        The gathered study.
    length : float
        Length L of the contact [m].

    Returns
    -------
    DataFrame
        One row per scene, theta, n_blocks and quantity: the value without noise, and what `statistics` has of
        all runs.
    """
    members = members.assign(front_speed_m_per_s=front_speed(members, length))
    rows = []
    for (scene, theta, n_blocks), runs in members.groupby(["scene", "theta", "n_blocks"], sort=False):
        for quantity in QUANTITIES:
            point = {"scene": scene, "theta": theta, "n_blocks": n_blocks, "quantity": quantity}
            without_noise = runs.loc[runs["load_noise"] == 0.0, quantity].item()
            rows.append(point | {"without_noise": without_noise} | statistics(runs[quantity]))
    return pd.DataFrame(rows)


def with_estimates(table: pd.DataFrame, slider: Mapping[str, Any]) -> pd.DataFrame:
    """A table of `resolution_table` with a column estimate: of mu_sapp, and of the front's speed [m/s].

    The front of a global slip is about as fast as long waves in the chain, sqrt(E S L/M); NaN for numbers
    that nothing is expected of.
    """
    friction = estimated_mu_sapp(table["n_blocks"], slider["mu_s"], slider["mu_k"])
    modulus, section = slider["youngs_modulus"], slider["cross_section"]
    wave_speed = np.sqrt(modulus * section * slider["length"] / slider["slider_mass"])
    is_friction, is_speed = (table["quantity"] == name for name in ("mu_sapp", "front_speed_m_per_s"))
    return table.assign(estimate=np.where(is_friction, friction, np.where(is_speed, wave_speed, np.nan)))


def extrapolation_table(resolution: pd.DataFrame, from_n_blocks: int) -> pd.DataFrame:
    """Carry each number on to an infinite number of blocks, by least squares over the medians.

    Parameters
    ----------
    resolution : DataFrame
        See `resolution_table`.
    from_n_blocks : int
        Smallest number of blocks that takes part.

    Returns
    -------
    DataFrame
        One row per scene and quantity: the law; a (the limit) and b, or c and p, with their standard errors;
        n_points, how many N took part. NaN where there are fewer than three.
    """
    rows = []
    for (scene, quantity), table in resolution.groupby(["scene", "quantity"], sort=False):
        law = LAWS[str(quantity)]
        used = table[(table["n_blocks"] >= from_n_blocks) & table["q50"].notna()]
        n_blocks, value = used["n_blocks"].to_numpy(float), used["q50"].to_numpy(float)
        if law == "c N^p":
            (power, factor), errors = straight_line(np.log(n_blocks), np.log(value))
            c = np.exp(factor)
            names = {"p": power, "p_error": errors[0], "c": c, "c_error": c * errors[1]}
        else:
            (slope, limit), errors = straight_line(1.0 / n_blocks, value)
            names = {"a": limit, "a_error": errors[1], "b": slope, "b_error": errors[0]}
        rows.append({"scene": scene, "quantity": quantity, "law": law, **names, "n_points": len(used)})
    return pd.DataFrame(rows)


def straight_line(x: FloatArray, y: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Slope and intercept of the line of least squares, and their standard errors; NaN below three points."""
    if len(x) < 3:
        return np.full(2, np.nan), np.full(2, np.nan)
    coefficients, covariance = np.polyfit(x, y, 1, cov="unscaled")
    spread = np.sum((y - np.polyval(coefficients, x)) ** 2) / (len(x) - 2)
    return coefficients, np.sqrt(np.diag(covariance) * spread)
