"""RK4 has the paper's count at steps at which all its transitions are right."""

import numpy as np
import pandas as pd
import pytest

from maegawa2010.studies.step_sweep import figure
from maegawa2010.studies.step_sweep.tables import sweep
from precursors import Chain, simulate


def rows_of(theta, *steps) -> list:
    exact = simulate(Chain.from_slider(theta=theta), 10.0)
    return [pd.Series(row) for row in sweep(exact, steps)]


@pytest.mark.parametrize(("theta", "right"), [(0.0, 216), ("5/6", 176)])
def test_rk4_has_the_papers_count_if_its_transitions_are_right(theta, right):
    """With a step of 1e-9 s, 176 of 338 transitions are right at theta = 5/6, and all 216
    at theta = 0."""
    exact, coarse, fine = rows_of(theta, 1e-5, 1e-9)
    assert np.isnan(exact.step_s)
    assert exact.transitions_right == exact.transitions_true
    assert coarse.transitions_right < 10
    assert fine.transitions_right == right
    assert fine.events_counted == exact.events_counted


def swept_steps():
    points = [
        ("exact", np.nan, 5, 10),
        ("rk4", 1e-5, 7, 3),
        ("rk4", 1e-7, 5, 10),
        ("rk4", 1e-6, 6, 4),
    ]
    rows = pd.DataFrame(
        points, columns=["method", "step_s", "events_counted", "transitions_right"]
    )
    rows = rows.assign(transitions_true=10)
    scenes = [rows.assign(scene=f"{theta}", theta=theta) for theta in (0.5, 0.0)]
    return figure.draw(pd.concat(scenes, ignore_index=True))


PICTURES = {"step_sweep": swept_steps}
