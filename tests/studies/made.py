"""A small study of each kind, of the scenes of the configuration."""

from functools import cache

import pandas as pd
from settings import CONFIG

from maegawa2010 import printed
from maegawa2010.scenes import scene_slider
from maegawa2010.studies.event_law.tables import event_law_study
from maegawa2010.studies.grid.tables import grid_study
from maegawa2010.studies.members import Study, run_members
from maegawa2010.studies.noise.tables import noise_study, noise_tables
from maegawa2010.studies.printed_digits.tables import digits_study
from maegawa2010.studies.resolution.tables import resolution_study

PAPER = {scene: printed.SCENES[scene] for scene in CONFIG["fig13"]}
SLIDERS = {scene: scene_slider(CONFIG, scene) for scene in CONFIG["fig13"]}
MAP = "grid"
OF_SCENES = {
    "noise_members": noise_study,
    "digits_members": digits_study,
    "resolution_members": resolution_study,
}


def study_of(name: str, settings: dict[str, object]) -> Study:
    """A study of the configuration with other settings of its own."""
    if name == MAP:
        return grid_study(CONFIG["chain"], settings["axes"])
    if name == "event_law_members":
        return event_law_study(CONFIG["chain"], settings)
    return OF_SCENES[name](SLIDERS, CONFIG["duration"], settings)


def noise_of(runs: int = 3) -> Study:
    """A small noise ensemble."""
    return study_of("noise_members", {"seed": 1, "runs": runs})


def chunks_of(name: str, **settings: object) -> list[pd.DataFrame]:
    """The runs of a small study, as its one chunk."""
    return [run_members(study_of(name, settings)).rename_axis("member").reset_index()]


@cache
def noise_made() -> dict[str, pd.DataFrame]:
    """The tables of a small noise ensemble."""
    return noise_tables(chunks_of("noise_members", seed=1, runs=8))


def members_of(events_counted: list[int], **mu_sapp: list[float]) -> pd.DataFrame:
    """Runs of scenes with these mu_sapp, NaN for a run without a global slip; draw 0 is
    the scene."""
    draws = {"draw": range(len(events_counted)), "events_counted": events_counted}
    same = {"theta": 0.0, "events_to_global_slip": 4, "global_slip_s": 2.0}
    tables = [
        pd.DataFrame({"scene": scene, **draws, **same, "mu_sapp": mu})
        for scene, mu in mu_sapp.items()
    ]
    members = pd.concat(tables, ignore_index=True)
    return members.assign(reached=members["mu_sapp"].notna())
