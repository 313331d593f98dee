"""The window of theta is even."""

import numpy as np
from ensembles.studies import study_of


def test_the_window_is_even_around_each_scene():
    study = study_of("theta_window_members", {"window": 0.0034, "points": 3})
    for _, own in study.members.groupby("scene"):
        theta = own["theta"].to_numpy()
        np.testing.assert_allclose(theta - theta[0], [0, -0.0034, 0, 0.0034], rtol=0, atol=1e-15)
