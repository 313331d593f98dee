"""The configuration of the workflow, and a small study of each kind."""

from pathlib import Path

import yaml

from maegawa2010 import printed
from maegawa2010.studies.members import Study
from maegawa2010.studies.registry import make_study, study_arguments

CONFIG = yaml.safe_load(
    (Path(__file__).parents[2] / "config.yaml").read_text(encoding="utf-8")
)
PAPER = {scene: printed.SCENES[scene] for scene in CONFIG["fig13"]}


def study_of(name: str, settings: dict[str, object]) -> Study:
    """A study of the configuration with other settings of its own."""
    section = "map" if name.startswith("map_") else name.removesuffix("_members")
    ensembles = {**CONFIG["ensembles"], section: settings}
    return make_study(name, study_arguments({**CONFIG, "ensembles": ensembles}, name))


def noise_of(runs: int = 3) -> Study:
    """A small noise ensemble."""
    return study_of("noise_members", {"seed": 1, "runs": runs})
