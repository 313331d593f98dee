"""Noise: the numbers of a scene when every normal load is known to a tenth of a per
cent only."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np
import pandas as pd

from maegawa2010.studies.members import (
    Study,
    differences_table,
    draws,
    gather,
    noise_table,
    stack,
    with_noise,
)
from maegawa2010.support.run_statistics import NOISE

# Other amplitudes of noise, each with runs / FEWER runs.
AMPLITUDES = (1e-4, 1e-2, 3e-2)
FEWER = 5


def noise_study(
    sliders: Mapping[str, Mapping[str, Any]],
    duration: float,
    settings: Mapping[str, Any],
) -> Study:
    """Runs of each scene with noise in the normal loads; draw 0 has none.

    Noise of another amplitude comes after them: the same draws, made smaller or larger.
    """
    few = np.arange(1, 1 + settings["runs"] // FEWER)
    noises = [draws(settings["runs"])]
    noises += [{"draw": few, "load_noise": amplitude} for amplitude in AMPLITUDES]
    blocks = [
        {**slider, **noise, "duration": duration, "scene": scene, "group": group}
        for noise in noises
        for group, (scene, slider) in enumerate(sliders.items())
    ]
    return Study(stack(blocks), seed=settings["seed"])


def noise_tables(chunks: Iterable[pd.DataFrame]) -> dict[str, pd.DataFrame]:
    """The tables of the study, by file name."""
    gathered = gather(chunks)
    members = gathered[gathered["load_noise"].isin((0.0, NOISE))]
    return {
        "noise_members": members,
        "noise": noise_table(members),
        "noise_differences": differences_table(members),
        "noise_amplitudes": amplitudes_table(gathered),
    }


def amplitudes_table(members: pd.DataFrame) -> pd.DataFrame:
    """Differences of mu_sapp, as in `differences_table`, for each amplitude of the
    noise."""
    tables = {
        amplitude: differences_table(runs).query("quantity == 'mu_sapp'")
        for amplitude, runs in with_noise(members).groupby("load_noise")
    }
    return pd.concat(tables, names=["load_noise"]).reset_index("load_noise")
