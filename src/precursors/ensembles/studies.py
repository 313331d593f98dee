"""The studies of a configuration by name."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from precursors.ensembles.event_law import event_law_study
from precursors.ensembles.friction_map import map_study
from precursors.ensembles.noise import noise_study
from precursors.ensembles.printed_digits import digits_study
from precursors.ensembles.resolution import resolution_study
from precursors.ensembles.study import Study
from precursors.ensembles.theta_window import theta_window_study
from precursors.model.scenes import Config, scene_slider

MAP = "map_theta_friction_ratio"
STUDIES: dict[str, Callable[..., Study]] = {
    "noise_members": noise_study,
    "digits_members": digits_study,
    "theta_window_members": theta_window_study,
    "resolution_members": resolution_study,
    "event_law_members": event_law_study,
    MAP: map_study,
}


def study_arguments(config: Config, name: str) -> dict[str, Any]:
    """What decides the members of a study: the arguments of its function in STUDIES."""
    settings = config["ensembles"]
    if name == MAP:
        return {"slider": config["chain"], "points": settings["map"]["points"]}
    own = settings[name.removesuffix("_members")]
    if name == "event_law_members":
        return {"slider": config["chain"], "settings": own}
    sliders = {scene: scene_slider(config, scene) for scene in config["fig13"]}
    return {"sliders": sliders, "duration": config["duration"], "settings": own}
