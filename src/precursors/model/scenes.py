"""The configuration of the workflow: its scenes, and the chain that each of them stands for."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from typing import Any

from precursors.model.chain import Chain, exact_theta_from_load_cells, parse_theta
from precursors.model.scene_models import ADDED, PAPERS_MODEL

Config = Mapping[str, Any]


def scene_names(config: Config) -> list[str]:
    """Names of the scenes, in the order of the configuration."""
    return list(config["scenes"])


def scene_model(config: Config, name: str) -> str:
    """The model of a scene, one of `MODEL_NAMES`."""
    return str(config["scenes"][name].get("model", PAPERS_MODEL))


def scene_additions(config: Config, name: str) -> dict[str, float]:
    """What a larger model adds to the paper's chain: fields of `hierarchy.larger.LargerChain`."""
    scene = config["scenes"][name]
    return {key: float(scene[key]) for key in ADDED.values() if key in scene}


def scene_outputs(config: Config, name: str) -> tuple[str, ...]:
    """What is made of a scene: a run, slips, a trace and a figure, or only answers if it names a model."""
    return ("answers",) if "model" in config["scenes"][name] else ("run", "slips", "trace", "figure")


def scenes_with(config: Config, output: str) -> list[str]:
    """Names of the scenes that have this output (see `scene_outputs`), in the order of the configuration."""
    return [name for name in scene_names(config) if output in scene_outputs(config, name)]


def scene_duration(config: Config, name: str) -> float:
    """Time that the scene is simulated for [s]."""
    return float(config["scenes"][name].get("duration", config["duration"]))


def scene_slider(config: Config, name: str) -> dict[str, Any]:
    """Arguments of `Chain.from_slider` for a scene: `chain`, the scene's own values, and its normal loading.

    Theta and the sum of two load cells are rounded once, to the nearest doubles.
    """
    slider = scene_as_written(config, name)
    rounded = {key: float(value) for key, value in slider.items() if isinstance(value, Fraction)}
    return slider | rounded | {"theta": parse_theta(slider["theta"])}


def scene_as_written(config: Config, name: str) -> dict[str, Any]:
    """The same before any rounding: numbers and theta as they are written, those of load cells as fractions.

    Two load cells give theta and the total normal load F_Z = F_ZA + F_ZB.
    """
    scene = config["scenes"][name]
    slider = {key: scene.get(key, value) for key, value in config["chain"].items()}
    if "theta" in scene:
        return slider | {"theta": scene["theta"]}
    a, b = scene["load_cell_a"], scene["load_cell_b"]
    theta = exact_theta_from_load_cells(
        a, b, spacing=config["load_cells"]["spacing"], length=slider["length"]
    )
    return slider | {"theta": theta, "normal_load": Fraction(repr(a)) + Fraction(repr(b))}


def scene_chain(config: Config, name: str) -> Chain:
    """The chain of a scene (Eqs. 7, 9 and 10)."""
    return Chain.from_slider(**scene_slider(config, name))
