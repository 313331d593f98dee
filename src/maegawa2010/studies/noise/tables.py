"""The numbers of a scene with 0.1 % of random noise in every normal load."""

from collections.abc import Iterable, Mapping
from typing import Any

import pandas as pd

from maegawa2010.studies.members import (
    Study,
    differences_table,
    draws,
    gather,
    noise_table,
    stack,
)


def noise_study(
    sliders: Mapping[str, Mapping[str, Any]],
    duration: float,
    settings: Mapping[str, Any],
) -> Study:
    """Runs of each scene with noise in the normal loads; draw 0 has none."""
    noise = draws(settings["runs"])
    blocks = [
        {**slider, **noise, "duration": duration, "scene": scene, "group": group}
        for group, (scene, slider) in enumerate(sliders.items())
    ]
    return Study(stack(blocks), seed=settings["seed"])


def noise_tables(chunks: Iterable[pd.DataFrame]) -> dict[str, pd.DataFrame]:
    """The tables of the study, by file name."""
    members = gather(chunks)
    return {
        "noise_members": members,
        "noise": noise_table(members),
        "noise_differences": differences_table(members),
    }
