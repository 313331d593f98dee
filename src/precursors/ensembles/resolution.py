"""Resolution: which numbers of the paper belong to the slider, and which to its N blocks."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from precursors.ensembles.cost import seconds_to_first_slip
from precursors.ensembles.study import Study
from precursors.model.chain import FloatArray
from precursors.model.scenes import Config, scene_slider

if TYPE_CHECKING:
    import pandas as pd

QUANTITIES = ("events_kept", "mu_sapp", "time_s", "front_speed_m_per_s")


# The law that each number is carried on by, from the smallest N that the configuration names.
LAWS = {
    "events_kept": "c N^p",
    "mu_sapp": "a + b/N",
    "time_s": "a + b/N",
    "front_speed_m_per_s": "a + b/N",
}


def resolution_study(config: Config) -> Study:
    """Chains of more and more blocks with the loading of the scenes of Fig. 13.

    The first member of each chain has the normal loads of Eq. 7, the others have them with noise. There are
    as many as `seconds_per_point` allows, between `least_runs` and `most_runs`.
    """
    settings = config["ensembles"]["resolution"]
    blocks: list[dict[str, Any]] = []
    for scene in config["fig13"]:
        for n_blocks in settings["n_blocks"]:
            n_runs = int(settings["seconds_per_point"] / seconds_to_first_slip(n_blocks))
            draw = np.arange(np.clip(n_runs, settings["least_runs"], settings["most_runs"]))
            slider = scene_slider(config, scene) | {"n_blocks": n_blocks, "scene": scene}
            blocks.append(slider | {"load_noise": np.where(draw == 0, 0.0, settings["noise"]), "draw": draw})
    for group, block in enumerate(blocks):
        block["group"] = group
    return Study.of_blocks("resolution_members", blocks, duration=config["duration"], seed=settings["seed"])


def estimated_mu_sapp(n_blocks: ArrayLike, mu_s: float, mu_k: float) -> FloatArray:
    """Estimate mu_k + 2 (mu_s - mu_k) / N of the apparent static friction coefficient [1].

    The load is the kinetic friction of all blocks, and above it the drop of the load when one block slides.
    """
    return mu_k + 2.0 * (mu_s - mu_k) / np.asarray(n_blocks, float)


def front_speed(n_blocks: NDArray, length: float, crossing_time: NDArray) -> FloatArray:
    """Mean speed [m/s] of the front of the first global slip from block 1 to block N."""
    distance = length * (n_blocks - 1) / n_blocks
    return np.divide(distance, crossing_time, out=np.full(len(n_blocks), np.nan), where=crossing_time > 0)


def resolution_table(
    members: pd.DataFrame, length: float, chains: Sequence[str] = ("scene", "theta")
) -> pd.DataFrame:
    """What the number of blocks makes of each number.

    Parameters
    ----------
    members : DataFrame
        The gathered study.
    length : float
        Length L of the contact [m].
    chains : sequence of str
        Columns that say which chain it is, whatever the number of its blocks.

    Returns
    -------
    DataFrame
        One row per chain, n_blocks and quantity: the value without noise; mean, standard deviation and
        quantiles over all members; q50_low and q50_high, see `run_statistics`; the number of members n.
    """
    import pandas as pd

    from precursors.analysis.run_statistics import statistics  # a plan of chunks waits for no statistics

    rows = []
    members = with_front_speed(members, length)
    for keys, runs in members.groupby([*chains, "n_blocks"], sort=False):
        [(_, without_noise)] = runs[runs["load_noise"] == 0.0].iterrows()
        for quantity in QUANTITIES:
            rows.append(
                {
                    **dict(zip([*chains, "n_blocks"], keys, strict=True)),
                    "quantity": quantity,
                    "without_noise": without_noise[quantity],
                    **statistics(runs[quantity]),
                }
            )
    return pd.DataFrame(rows)


def with_front_speed(members: pd.DataFrame, length: float) -> pd.DataFrame:
    """A gathered study with a column front_speed_m_per_s, for a contact of length [m]."""
    speed = front_speed(members["n_blocks"].to_numpy(), length, members["crossing_time_s"].to_numpy())
    return members.assign(front_speed_m_per_s=speed)


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
    import pandas as pd

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
