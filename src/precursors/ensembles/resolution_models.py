"""Resolution of chains with viscosity and interface springs: does N drop out of the paper's numbers?"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from precursors.ensembles.cost import seconds_to_first_slip
from precursors.ensembles.resolution import QUANTITIES, resolution_table, with_front_speed
from precursors.ensembles.study import Study
from precursors.model.chain import parse_theta
from precursors.model.scenes import Config
from precursors.model.slider import spring_stiffness

if TYPE_CHECKING:
    import pandas as pd

ADDITIONS = ("viscosity", "interface_stiffness")
CHAINS = ("model", "theta", "viscous_time", *ADDITIONS)
WITH_UNITS = {
    "viscous_time": "viscous_time_s",
    "viscosity": "viscosity_N_s_per_m",
    "interface_stiffness": "interface_stiffness_N_per_m",
}


def resolution_models_study(config: Config, size: Literal["default", "full"] = "default") -> Study:
    """Chains of more and more blocks with the additions that `resolution_models.models` names.

    As in `resolution_study`, but a number of blocks of which one run would take longer than `longest_run` is
    left out. The full study has the runs that `resolution_models.full` allows.
    """
    settings = config["resolution_models"]
    name = "resolution_models_members"
    if size == "full":
        settings, name = settings | settings["full"], "resolution_models_full_members"
    blocks: list[dict[str, Any]] = []
    for model, values in settings["models"].items():
        for theta in settings["theta"]:
            for n_blocks in settings["n_blocks"]:
                slider = config["chain"] | {"n_blocks": n_blocks, "theta": parse_theta(theta)}
                additions = slider_additions(slider, values)
                added = additions["interface_stiffness"], additions["viscosity"]
                seconds = float(seconds_to_first_slip(n_blocks, *added))
                if seconds > settings["longest_run"]:
                    continue
                n_runs = int(settings["seconds_per_point"] / seconds)
                draw = np.arange(np.clip(n_runs, settings["least_runs"], settings["most_runs"]))
                noise = np.where(draw == 0, 0.0, settings["noise"])
                labels = {"model": model, "viscous_time": values.get("relaxation_time", 0.0)}
                blocks.append(slider | additions | labels | {"load_noise": noise, "draw": draw})
    for group, block in enumerate(blocks):
        block["group"] = group
    return Study.of_blocks(name, blocks, duration=config["duration"], seed=settings["seed"])


def slider_additions(slider: Mapping[str, Any], values: Mapping[str, float]) -> dict[str, float]:
    """Arguments of `Chain.from_slider` for physical values of the additions.

    A Kelvin-Voigt solid of relaxation time t_v has dashpots eta = k t_v, the stiffer the more blocks.
    """
    viscosity = values.get("viscosity", 0.0)
    viscosity += values.get("relaxation_time", 0.0) * spring_stiffness(slider)
    return {"viscosity": viscosity, "interface_stiffness": values.get("interface_stiffness", 0.0)}


def resolution_models_table(members: pd.DataFrame, study: Study) -> pd.DataFrame:
    """What the number of blocks makes of each number, model by model.

    Parameters
    ----------
    members : DataFrame
        The gathered study.
    study : Study
        The study, which has the values that its members have in common.

    Returns
    -------
    DataFrame
        As `resolution_table`, one row per model, theta, n_blocks and quantity, with the values of the model.
    """
    runs = labelled(members, study)
    return resolution_table(runs, study.slider["length"], CHAINS).rename(columns=WITH_UNITS)


def resolution_models_runs(members: pd.DataFrame, study: Study) -> pd.DataFrame:
    """The numbers of every run, which quantiles of a few runs do not show.

    Parameters
    ----------
    members, study
        See `resolution_models_table`.

    Returns
    -------
    DataFrame
        One row per run and quantity that the run has: model, theta, the values of the model, n_blocks, draw,
        quantity, value.
    """
    runs = with_front_speed(labelled(members, study), study.slider["length"])
    values = runs.melt([*CHAINS, "n_blocks", "draw"], QUANTITIES, "quantity", "value")
    return values.dropna(subset="value").rename(columns=WITH_UNITS)


def labelled(members: pd.DataFrame, study: Study) -> pd.DataFrame:
    """The gathered study with the columns `CHAINS`."""
    members = members.assign(**{name: study.column(name) for name in ("theta", *ADDITIONS)})
    # The dashpots of a material differ from N to N: its relaxation time stands for them.
    return members.assign(viscosity=members["viscosity"].where(members["viscous_time"] == 0.0, 0.0))
