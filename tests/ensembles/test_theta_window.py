"""The window of theta is even, and within the values that theta may have."""

import numpy as np
from ensembles.studies import study_of

from precursors.ensembles.theta_window import theta_window_study


def test_the_window_is_even_around_each_scene():
    study = study_of("theta_window_members", {"window": 0.0034, "points": 3})
    for _, own in study.members.groupby("scene"):
        theta = own["theta"].to_numpy()
        np.testing.assert_allclose(theta - theta[0], [0, -0.0034, 0, 0.0034], rtol=0, atol=1e-15)


def test_the_window_ends_where_no_load_is_left_at_an_edge():
    scenes = {"trailing": {"theta": -0.9}, "leading": {"theta": 0.9}}
    theta = theta_window_study(scenes, 1.0, {"window": 0.2, "points": 2}).members["theta"]
    np.testing.assert_allclose(theta, [-0.9, -1.0, -0.7, 0.9, 0.7, 1.0], rtol=1e-15)
