"""The scenes of a configuration, and the chain of each scene."""

import math
from collections.abc import Mapping, Sequence
from fractions import Fraction
from typing import Any

from precursors.model.chain import SLIDER, parse_theta, theta_from_load_cells
from precursors.support.measured import read_weights

Config = Mapping[str, Any]


def scenes_with_theta(config: Config) -> list[str]:
    """Names of the scenes whose normal load varies linearly along the slider."""
    return [name for name, scene in config["scenes"].items() if "weights" not in scene]


def scene_duration(config: Config, name: str) -> float:
    """Simulated time of a scene [s]."""
    return float(config["scenes"][name].get("duration", config["duration"]))


def is_paper_slider(config: Config, scenes: Sequence[str]) -> bool:
    """Whether these scenes, in the order of theta, are in Fig. 13 and have the paper's
    values."""
    return all(
        scene in config["fig13"]
        and {"weights": None} | scene_slider(config, scene) == SLIDER | {"theta": theta}
        for scene, theta in zip(scenes, (-5 / 6, 0.0, 5 / 6), strict=True)
    )


def scene_label(config: Config, name: str) -> dict[str, str]:
    """Name and title of a scene for the report; Snakemake would take braces for
    wildcards."""
    title = config["scenes"][name]["title"].replace("{", "(").replace("}", ")")
    return {"figure": f"{name}: {title}"}


def scene_slider(config: Config, name: str) -> dict[str, Any]:
    """Arguments of `Chain.from_slider` for a scene; theta and F_Z are rounded once.

    With measured normal loads [N], from a list or a file, theta is NaN.
    """
    slider = scene_as_written(config, name)
    if "weights" not in slider:
        return slider | {
            "theta": parse_theta(slider["theta"]),
            "normal_load": float(slider["normal_load"]),
        }
    loads = slider["weights"]
    if isinstance(loads, str):
        loads = read_weights(loads)
    return slider | {
        "weights": loads,
        "n_blocks": len(loads),
        "normal_load": math.fsum(loads),
        "theta": math.nan,
    }


def scene_as_written(config: Config, name: str) -> dict[str, Any]:
    """Arguments for a scene before rounding: theta and F_Z from load cells are exact
    fractions."""
    scene = config["scenes"][name]
    slider = {key: scene.get(key, value) for key, value in config["chain"].items()}
    if "load_cell_a" not in scene:
        given = {key: scene[key] for key in ("theta", "weights") if key in scene}
        return slider | given
    a = scene["load_cell_a"]
    b = scene["load_cell_b"]
    theta = theta_from_load_cells(
        a, b, spacing=config["load_cells"]["spacing"], length=slider["length"]
    )
    return slider | {
        "theta": theta,
        "normal_load": Fraction(repr(a)) + Fraction(repr(b)),
    }
