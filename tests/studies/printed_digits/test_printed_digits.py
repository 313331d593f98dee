"""Random sliders round to the printed inputs, and their agreement is counted."""

import numpy as np
import pytest
from settings import SLIDERS
from studies.runs import runs_of

from maegawa2010.studies.printed_digits.tables import (
    HALF_A_DIGIT,
    digits_study,
    digits_table,
)

NAN = np.nan


def test_every_draw_prints_as_the_paper_does():
    members = digits_study(SLIDERS, 10.0, {"seed": 1, "draws": 50}).members
    draws = members[members["draw"] > 0]
    assert (
        draws["theta"].abs() - 0.833 * (draws["scene"] != "fig10")
    ).abs().max() <= 0.0005
    for name, printed in {"mu_s": 0.70, "mu_k": 0.45, "drive_velocity": 1e-4}.items():
        assert 0.9 < draws[name].sub(printed).abs().max() / HALF_A_DIGIT[name] <= 1.0
    assert draws.groupby("draw")["drive_stiffness"].nunique().eq(1).all()


def test_shares_of_agreement_are_those_counted_by_hand():
    """Draw 4 has no global slip in one scene, and draw 5 in both, so they do not agree.
    Draw 1 has all numbers."""
    mu = {
        "a": [0.5, 0.50, 0.50, 0.50, NAN, NAN],
        "b": [0.5, 0.504, 0.52, 0.491, 0.5, NAN],
    }
    paper = {scene: {"events_counted": 3, "mu_sapp": 0.5} for scene in mu}
    table = digits_table(runs_of([3, 3, 3, 4, 3, 3], **mu), paper)
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
