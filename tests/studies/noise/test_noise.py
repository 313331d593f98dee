"""The members of the noise study, and their quantiles."""

import numpy as np
import pytest
from settings import SLIDERS
from studies.runs import runs_of

from maegawa2010.studies.members import chain_of, noise_table
from maegawa2010.studies.noise.tables import noise_study
from maegawa2010.support.run_statistics import NOISE

NAN = np.nan


def test_draw_0_is_the_scene_and_the_others_have_noise():
    members = noise_study(SLIDERS, 10.0, {"seed": 1, "runs": 3}).members
    for _, runs in members.groupby("scene"):
        scene, *noisy = (
            chain_of(member, 1).weights for member in runs.to_dict("records")
        )
        for weights in noisy:
            change = weights / scene - 1
            assert (change != 0).all()
            assert (np.abs(change) <= NOISE).all()


def test_quantiles_are_those_of_noisy_runs_with_a_global_slip():
    row = noise_table(runs_of([5] * 13, a=[0.9, NAN, *np.linspace(0.4, 0.5, 11)])).iloc[
        0
    ]
    assert (row["runs"], row["reached"]) == (12, 11)
    assert (row["q50"], row["q05"], row["q95"]) == pytest.approx((0.45, 0.405, 0.495))
