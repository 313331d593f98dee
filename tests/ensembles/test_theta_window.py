"""The window of theta is even, and its table is that of the runs in it."""

import numpy as np
import pytest
from ensembles.studies import study_of

from precursors.ensembles.study import run_members
from precursors.ensembles.theta_window import theta_window_table


def test_the_window_is_even_around_each_scene_and_its_table_has_no_scene_itself():
    study = study_of("theta_window_members", {"window": 0.0034, "points": 3})
    for _, own in study.members.groupby("scene"):
        theta = own["theta"].to_numpy()
        np.testing.assert_allclose(theta - theta[0], [0, -0.0034, 0, 0.0034], rtol=0, atol=1e-15)
    members = run_members(study)
    table = theta_window_table(members).set_index(["scene", "quantity"])
    row = table.loc[("fig11", "mu_sapp")]
    assert row["at_theta"] == pytest.approx(0.4845, abs=1e-4)
    assert (row["n"], row["share_same"]) == (3, 1.0)
    counts = members[(members["scene"] == "fig12") & (members["point"] > 0)]["events_counted"]
    assert table.loc[("fig12", "events_counted"), "share_same"] == (counts == 14).mean()
