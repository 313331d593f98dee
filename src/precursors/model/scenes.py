"""The scenes of a configuration, and the chain that each of them stands for."""

from __future__ import annotations

import inspect
from collections.abc import Mapping
from fractions import Fraction
from typing import Any

from precursors.model.chain import Chain, exact_theta_from_load_cells, parse_theta

Config = Mapping[str, Any]

# Arguments of `Chain.from_slider` and their defaults, the paper's.
SLIDER = {name: p.default for name, p in inspect.signature(Chain.from_slider).parameters.items()}
PAPERS_MODEL = "chain"
# Models that add to the paper's chain, and the field of `hierarchy.larger.LargerChain` that each one needs.
ADDED = {"viscous": "viscosity", "interface": "interface_stiffness", "head": "head_mass"}


def scenes_with(config: Config, output: str) -> list[str]:
    """Names of the scenes that have a "run", or "answers" because they name a model, in order."""
    return [name for name, scene in config["scenes"].items() if ("model" in scene) == (output == "answers")]


def scene_model(config: Config, name: str) -> str:
    """The model of a scene, a key of `hierarchy.models.MODELS`."""
    return str(config["scenes"][name].get("model", PAPERS_MODEL))


def scene_duration(config: Config, name: str) -> float:
    """Time that the scene is simulated for [s]."""
    return float(config["scenes"][name].get("duration", config["duration"]))


def scene_slider(config: Config, name: str) -> dict[str, Any]:
    """Arguments of `Chain.from_slider` for a scene; theta and F_Z are rounded once."""
    slider = scene_as_written(config, name)
    return slider | {"theta": parse_theta(slider["theta"]), "normal_load": float(slider["normal_load"])}


def scene_additions(config: Config, name: str) -> dict[str, float]:
    """What a larger model adds to the paper's chain, by its key in the scene.

    Raises
    ------
    ValueError
        If the model needs an addition that the scene does not give, or has none and the scene gives one.
    """
    model, scene = scene_model(config, name), config["scenes"][name]
    given = {key: float(scene[key]) for key in ADDED.values() if key in scene}
    if model in ADDED and ADDED[model] not in given:
        raise ValueError(f"the model {model!r} needs {ADDED[model]}")
    if given and model not in ADDED:
        raise ValueError(
            f"{', '.join(given)} must not be given for the model {model!r}, only for {', '.join(ADDED)}"
        )
    return given


def scene_as_written(config: Config, name: str) -> dict[str, Any]:
    """The same before any rounding: theta and F_Z = F_ZA + F_ZB of two load cells are fractions.

    Raises
    ------
    ValueError
        If the scene gives both theta and load cells, or neither.
    """
    scene = config["scenes"][name]
    slider = {key: scene.get(key, value) for key, value in config["chain"].items()}
    cells = [key for key in ("load_cell_a", "load_cell_b") if key in scene]
    if ("theta" in scene) == bool(cells) or len(cells) == 1:
        given = " and ".join([key for key in ("theta", *cells) if key in scene]) or "neither"
        raise ValueError(f"needed is either theta or both load_cell_a and load_cell_b, but given is {given}")
    if "theta" in scene:
        return slider | {"theta": scene["theta"]}
    if "normal_load" in scene:
        raise ValueError("normal_load must not be given beside load cells, whose sum it is")
    a, b = scene["load_cell_a"], scene["load_cell_b"]
    theta = exact_theta_from_load_cells(
        a, b, spacing=config["load_cells"]["spacing"], length=slider["length"]
    )
    return slider | {"theta": theta, "normal_load": Fraction(repr(a)) + Fraction(repr(b))}


def scene_chain(config: Config, name: str) -> Chain:
    """The chain of a scene (Eqs. 7, 9 and 10)."""
    return Chain.from_slider(**scene_slider(config, name))
