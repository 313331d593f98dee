"""The configuration of the workflow, and a small study of each kind."""

from pathlib import Path

import yaml

from precursors.ensembles.catalogue import STUDIES, study_arguments
from precursors.ensembles.study import Study

CONFIG = yaml.safe_load((Path(__file__).parents[2] / "config.yaml").read_text(encoding="utf-8"))
SPREAD = {
    "seed": 1,
    "members": 3,
    "loads": [1e-12, 1e-2],
    "start": [1e-2],
    "parameters": [1e-2],
    "theta": {"window": 0.0034, "points": 3},
}


def study_of(name: str, settings: dict[str, object]) -> Study:
    """A study of the configuration with other settings of its own."""
    section = "maps" if name.startswith("map_") else name.removesuffix("_members")
    ensembles = {**CONFIG["ensembles"], section: settings}
    return STUDIES[name](**study_arguments({**CONFIG, "ensembles": ensembles}, name))


def spread_of(**settings: object) -> Study:
    """A small study of the spread."""
    return study_of("spread_members", {**SPREAD, **settings})
