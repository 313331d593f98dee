"""Sliders that are printed alike, and the probability that a number is the same for all."""

import numpy as np
import pandas as pd
import pytest
from ensembles.studies import study_of

from precursors.ensembles.digits import HALF_A_DIGIT, digits_table
from precursors.ensembles.study import run_members


def test_every_draw_prints_as_the_paper_does_and_is_the_same_slider_in_each_scene():
    members = study_of("digits_members", {"seed": 1, "draws": 50}).members
    draws = members[members["draw"] > 0]
    for theta, printed in ((-5 / 6, -0.833), (0.0, 0.0), (5 / 6, 0.833)):
        scene = members.loc[(members["draw"] == 0) & np.isclose(members["theta"], theta), "scene"].item()
        own = draws[draws["scene"] == scene]
        assert (own["theta"].sub(printed).abs() <= 0.0005).all()
        assert set(own["mu_s"].sub(0.70).abs() <= HALF_A_DIGIT["mu_s"]) == {True}
    assert draws.groupby("draw")["drive_stiffness"].nunique().eq(1).all()
    assert draws["drive_velocity"].between(0.05e-3, 0.15e-3).all()


def test_the_scene_as_it_is_has_the_papers_numbers():
    members = run_members(study_of("digits_members", {"seed": 1, "draws": 2}))
    assert members.loc[members["draw"] == 0, "events_counted"].tolist() == [6, 9, 14]
    assert members["reached"].all()


def test_the_probability_of_agreement_by_hand():
    """Draw 4 has no global slip in one scene, draw 5 in none: they do not agree."""
    mu = {"a": [0.5, 0.50, 0.50, 0.50, np.nan, np.nan], "b": [0.5, 0.504, 0.52, 0.491, 0.5, np.nan]}
    members = pd.concat(
        pd.DataFrame({"scene": name, "draw": range(6), "mu_sapp": values, "events_counted": 3, "n_events": 4})
        for name, values in mu.items()
    )
    table = digits_table(members).set_index(["scene", "quantity"])
    assert table.loc[("a", "mu_sapp"), "probability"] == 0.6
    assert table.loc[("b", "mu_sapp"), "probability"] == 0.4
    same = table.loc[("all, same slider", "range of mu_sapp")]
    assert (same["probability"], same["n"]) == (0.4, 5)
    assert same["largest"] == pytest.approx(0.02)
