"""Noise and printed digits by hand: runs without a global slip, ends of intervals,
draws that print alike."""

import numpy as np
import pandas as pd
import pytest
from studies.made import noise_of, study_of

from maegawa2010.studies.members import chain_of
from maegawa2010.studies.noise.tables import noise_table
from maegawa2010.studies.printed_digits.tables import HALF_A_DIGIT, digits_table
from maegawa2010.support.run_statistics import NOISE, compared

NAN = np.nan


def members_of(events_counted: list[int], **mu_sapp: list[float]) -> pd.DataFrame:
    """Runs of scenes with these mu_sapp, NaN for a run without a global slip; draw 0 is
    the scene."""
    draws = {"draw": range(len(events_counted)), "events_counted": events_counted}
    same = {"theta": 0.0, "events_to_global_slip": 4, "time_s": 2.0}
    tables = [
        pd.DataFrame({"scene": scene, **draws, **same, "mu_sapp": mu})
        for scene, mu in mu_sapp.items()
    ]
    members = pd.concat(tables, ignore_index=True)
    return members.assign(reached=members["mu_sapp"].notna())


def test_draw_0_is_the_scene_and_the_others_have_noise_in_every_normal_load():
    members = noise_of().members
    for _, runs in members.groupby("scene"):
        scene, *noisy = (
            chain_of(member, 1).weights for member in runs.to_dict("records")
        )
        for weights in noisy:
            change = weights / scene - 1
            assert (change != 0).all()
            assert (np.abs(change) <= NOISE).all()


def test_a_distribution_is_that_of_the_noisy_runs_with_a_global_slip():
    row = noise_table(
        members_of([5] * 13, a=[0.9, NAN, *np.linspace(0.4, 0.5, 11)])
    ).iloc[0]
    assert (row["without_noise"], row["runs"], row["reached"]) == (0.9, 12, 11)
    assert (row["q50"], row["q05"], row["q95"]) == pytest.approx((0.45, 0.405, 0.495))


@pytest.mark.parametrize(
    ("low", "high", "verdict"),
    [
        (-0.01, 0.01, "same"),
        (0.0, 0.011, "undecided"),
        (0.011, 0.02, "different"),
        (-0.3, -0.2, "different"),
        (-0.3, 0.3, "undecided"),
    ],
)
def test_the_whole_interval_decides(low, high, verdict):
    assert compared(low, high, 0.01) == verdict


def test_every_draw_prints_as_the_paper_does():
    members = study_of("digits_members", {"seed": 1, "draws": 50}).members
    draws = members[members["draw"] > 0]
    assert (
        draws["theta"].abs() - 0.833 * (draws["scene"] != "fig10")
    ).abs().max() <= 0.0005
    for name, printed in {"mu_s": 0.70, "mu_k": 0.45, "drive_velocity": 1e-4}.items():
        assert 0.9 < draws[name].sub(printed).abs().max() / HALF_A_DIGIT[name] <= 1.0
    assert draws.groupby("draw")["drive_stiffness"].nunique().eq(1).all()


def test_agreement_by_hand():
    """Draw 4 has no global slip in one scene, draw 5 in none: they do not agree. Draw 1
    has all numbers."""
    mu = {
        "a": [0.5, 0.50, 0.50, 0.50, NAN, NAN],
        "b": [0.5, 0.504, 0.52, 0.491, 0.5, NAN],
    }
    paper = {scene: {"events_counted": 3, "mu_sapp": 0.5} for scene in mu}
    table = digits_table(members_of([3, 3, 3, 4, 3, 3], **mu), paper)
    table = table.set_index(["scene", "quantity", "question"])
    hits = table["k"]
    assert hits["a", "mu_sapp", "as_printed"] == 3
    assert hits["b", "mu_sapp", "as_printed"] == 3
    assert hits["b", "events_counted", "as_printed"] == 4
    assert hits["all", "mu_sapp", "same_mu_sapp"] == 2
    assert hits["all", "all", "all_six"] == 1
    of_b = table.loc[("b", "mu_sapp", "as_printed")]
    assert of_b[["q05", "q50", "q95"]].tolist() == pytest.approx(
        [0.49235, 0.502, 0.5176]
    )
