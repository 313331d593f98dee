"""Values of theta around those of the scenes."""

import numpy as np
import pandas as pd
import pytest
from studies.made import study_of

from maegawa2010.studies.theta_window import figure


def window_of_theta():
    members = {
        "scene": "s",
        "theta": [0.5, 0.4, 0.45, 0.5, 0.55, 0.6],
        "point": range(6),
        "events_counted": 4,
    }
    return figure.draw(
        pd.DataFrame(members).assign(mu_sapp=[0.5, 0.5, 0.51, 0.51, 0.53, np.nan])
    )


PICTURES = {"theta_window": window_of_theta}


def test_the_window_lies_around_each_scene_and_ends_at_the_largest_theta():
    members = study_of("theta_window_members", {"window": 0.2, "points": 3}).members
    found = {scene: list(of["theta"]) for scene, of in members.groupby("scene")}
    assert found["fig10"] == pytest.approx([0.0, -0.2, 0.0, 0.2])
    assert found["fig12"] == pytest.approx([5 / 6, 5 / 6 - 0.2, 5 / 6, 1.0])
    assert found["fig11"] == pytest.approx([-5 / 6, -1.0, -5 / 6, -5 / 6 + 0.2])
