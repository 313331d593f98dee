"""The studies of a configuration by name."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from itertools import permutations
from typing import Any

from precursors.ensembles.digits import digits_study
from precursors.ensembles.endless import endless_study
from precursors.ensembles.event_law import event_law_study
from precursors.ensembles.maps import PARAMETERS, map_study
from precursors.ensembles.resolution import resolution_study
from precursors.ensembles.spread import spread_study
from precursors.ensembles.study import Study
from precursors.model.scenes import Config, scene_slider

MAPS = {f"map_{x}_{y}": (x, y) for x, y in permutations(PARAMETERS, 2)}
STUDIES: dict[str, Callable[..., Study]] = {
    "spread_members": spread_study,
    "resolution_members": resolution_study,
    "digits_members": digits_study,
    "event_law_members": event_law_study,
    "event_law_full_members": event_law_study,
    "endless_members": endless_study,
    "endless_full_members": endless_study,
    **{name: partial(map_study, x=x, y=y) for name, (x, y) in MAPS.items()},
}


def study_arguments(config: Config, name: str) -> dict[str, Any]:
    """What decides the members of a study: the arguments of its function in STUDIES."""
    settings = config["ensembles"]
    if name in MAPS:
        return {"slider": config["chain"], "points": settings["maps"]["points"]}
    if name.startswith(("event_law", "endless")):
        return {"slider": config["chain"], "settings": settings[name.removesuffix("_members")]}
    return {
        "sliders": {scene: scene_slider(config, scene) for scene in config["fig13"]},
        "duration": config["duration"],
        "settings": settings[name.removesuffix("_members")],
    }
