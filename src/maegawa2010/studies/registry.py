"""The studies of a configuration by name."""

from __future__ import annotations

from pkgutil import resolve_name
from typing import TYPE_CHECKING, Any

from maegawa2010.scenes import Config, scene_slider

if TYPE_CHECKING:
    from maegawa2010.studies.members import Study

MAP = "map_theta_friction_ratio"
# Module and function of each study, imported when the study is made: reading the rules
# must not load Numba.
STUDIES = {
    "noise_members": "noise.tables.noise_study",
    "digits_members": "printed_digits.tables.digits_study",
    "theta_window_members": "theta_window.tables.theta_window_study",
    "resolution_members": "resolution.tables.resolution_study",
    "event_law_members": "event_law.tables.event_law_study",
    MAP: "friction_map.tables.map_study",
}
PREDICTED_UP_TO = 30  # blocks; the predictability time of longer chains takes minutes


def make_study(name: str, arguments: dict[str, Any]) -> Study:
    """A study by its name and the arguments of its function."""
    study: Study = resolve_name(f"maegawa2010.studies.{STUDIES[name]}")(**arguments)
    return study


def study_arguments(config: Config, name: str) -> dict[str, Any]:
    """Arguments of the function of a study, which decide its members."""
    settings = config["ensembles"]
    if name == MAP:
        return {"slider": config["chain"], "points": settings["map"]["points"]}
    own = settings[name.removesuffix("_members")]
    if name == "event_law_members":
        return {"slider": config["chain"], "settings": own}
    sliders = {scene: scene_slider(config, scene) for scene in config["fig13"]}
    return {"sliders": sliders, "duration": config["duration"], "settings": own}
