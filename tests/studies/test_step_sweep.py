"""The step of RK4: its numbers are the paper's where all transitions are right."""

import numpy as np
import pandas as pd
import pytest

from maegawa2010.studies.step_sweep import figure
from maegawa2010.studies.step_sweep.tables import charted_steps, sweep
from precursors import Chain, simulate


def rows_of(theta, *steps) -> list:
    exact = simulate(Chain.from_slider(theta=theta), 10.0)
    return [pd.Series(row) for row in sweep(exact, steps)]


def test_steps_run_evenly_from_the_coarsest_to_the_finest_and_the_full_chart_has_more():
    for full, n in ((False, 25), (True, 97)):
        steps = charted_steps(full)
        assert (len(steps), steps[0], steps[-1]) == (n, 1e-5, pytest.approx(1e-9))
        np.testing.assert_allclose(steps[1:] / steps[:-1], steps[1] / steps[0])


@pytest.mark.parametrize(("theta", "right"), [(0.0, 216), ("5/6", 176)])
def test_a_sweep_gives_the_papers_numbers_where_the_transitions_are_right(theta, right):
    """Known: at theta = 5/6 and 1e-9 s it is right in 176 of 338 transitions, at 0 in
    all 216."""
    exact, coarse, fine = rows_of(theta, 1e-5, 1e-9)
    assert np.isnan(exact.step_s)
    assert exact.transitions_right == exact.transitions_true
    assert coarse.transitions_right < 10
    assert fine.transitions_right == right
    is_all = right == exact.transitions_true
    assert (fine.mu_sapp == pytest.approx(exact.mu_sapp, abs=1e-4)) == is_all
    assert fine.events_counted == exact.events_counted


def test_a_step_far_beyond_the_limit_makes_a_global_slip_of_the_first_event():
    exact, broken = rows_of(0.0, 3e-5)
    assert (broken.events_counted, broken.transitions_right) == (1, 1)
    assert broken.mu_sapp == pytest.approx(28.0 / 400.0, rel=1e-9)
    assert exact.events_counted == 9


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
    rows = rows.assign(mu_sapp=0.1 * rows["events_counted"], transitions_true=10)
    scenes = [rows.assign(scene=f"{theta}", theta=theta) for theta in (0.5, 0.0)]
    return figure.draw(pd.concat(scenes, ignore_index=True))


PICTURES = {"step_sweep": swept_steps}
