"""Sliders that are printed alike, and how many of them have a number."""

import numpy as np
import pandas as pd
import pytest
from ensembles.studies import study_of

from precursors.ensembles.printed_digits import HALF_A_DIGIT, digits_table, share_row


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


def test_agreement_by_hand():
    """Draw 4 has no global slip in one scene, draw 5 in none: they do not agree. Draw 1 has all numbers."""
    mu = {"a": [0.5, 0.50, 0.50, 0.50, np.nan, np.nan], "b": [0.5, 0.504, 0.52, 0.491, 0.5, np.nan]}
    members = pd.concat(
        pd.DataFrame(
            {
                "scene": name,
                "draw": range(6),
                "mu_sapp": values,
                "events_counted": [3, 3, 3, 4, 3, 3],
                "events_to_global_slip": 4,
            }
        )
        for name, values in mu.items()
    )
    paper = {name: {"events_counted": 3, "mu_sapp": 0.5} for name in mu}
    table = digits_table(members, paper).set_index(["scene", "quantity", "question"])["k"]
    assert table["a", "mu_sapp", "as printed"] == 3
    assert table["b", "mu_sapp", "as in the run"] == 3
    assert table["b", "events_counted", "as printed"] == 4
    assert table["all", "mu_sapp", "same mu_sapp"] == 2
    assert table["all", "all", "all six numbers"] == 1


@pytest.mark.parametrize(
    ("k", "n", "name"), [(400, 400, "robust"), (19, 20, "undecided"), (1, 20, "fragile")]
)
def test_the_interval_of_the_share_decides_the_class(k, n, name):
    assert share_row(pd.Series([True] * k + [False] * (n - k)))["class"] == name
