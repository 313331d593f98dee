"""Each number is tabulated for every N, and carried on to infinite N by the laws of the textbook."""

import numpy as np
import pandas as pd
import pytest
from ensembles.studies import CONFIG, study_of

from precursors import Chain, simulate
from precursors.analysis.summary import summarise
from precursors.ensembles import resolution
from precursors.ensembles.study import WITH_UNITS, run_members

SETTINGS = {"seed": 1, "noise": 1e-3, "n_blocks": [2, 10], "runs": [6, 3]}


def test_each_chain_is_run_once_without_noise_and_else_with_it():
    study = study_of("resolution_members", SETTINGS)
    runs = study.members.groupby(["scene", "n_blocks"])["load_noise"]
    assert runs.size().to_dict() == {(scene, n): r for scene in CONFIG["fig13"] for n, r in ((2, 6), (10, 3))}
    assert all((noise == 0.0).sum() == 1 for _, noise in runs)


def test_the_table_has_statistics_of_each_number_for_every_scene_and_number_of_blocks():
    rows = run_members(study_of("resolution_members", SETTINGS))
    table = resolution.resolution_table(rows, length=0.1).set_index(["scene", "n_blocks", "quantity"])
    assert len(table) == 3 * 2 * len(resolution.QUANTITIES)
    friction = table.loc[("fig10", 10, "mu_sapp")]
    assert friction["without_noise"] == pytest.approx(0.48576, abs=1e-5)
    of_point = rows[(rows["scene"] == "fig10") & (rows["n_blocks"] == 10)]["mu_sapp"]
    assert (friction["q50"], friction["n"]) == (of_point.median(), 3)


def test_the_estimate_comes_nearer_to_kinetic_friction_with_every_block():
    estimate = resolution.estimated_mu_sapp([1, 10, 200, 10**9], 0.7, 0.45)
    np.testing.assert_allclose(estimate, [0.95, 0.5, 0.4525, 0.45], rtol=1e-8)


def test_an_exact_law_is_carried_on_exactly():
    n_blocks = np.array([5, 20, 40, 80, 160])
    laws = {"mu_sapp": 0.45 + 0.5 / n_blocks, "events_kept": 2.0 * n_blocks**0.75}
    laws["mu_sapp"][0] = 9.9  # below the smallest N that takes part
    table = pd.concat(
        pd.DataFrame({"scene": "s", "quantity": name, "n_blocks": n_blocks, "q50": values})
        for name, values in laws.items()
    )
    found = resolution.extrapolation_table(table, from_n_blocks=20).set_index("quantity")
    assert found.loc["mu_sapp", ["a", "b"]].tolist() == pytest.approx([0.45, 0.5], rel=1e-12)
    assert found.loc["events_kept", ["c", "p"]].tolist() == pytest.approx([2.0, 0.75], rel=1e-12)
    assert found.loc["mu_sapp", "a_error"] < 1e-12
    assert set(found["n_points"]) == {4}


def test_the_errors_of_a_line_are_those_of_the_textbook():
    x, y = np.array([0.0, 1.0, 2.0, 3.0]), np.array([0.0, 1.0, 1.0, 3.0])
    slope, intercept = 0.9, -0.1
    variance = (0.1**2 + 0.2**2 + 0.7**2 + 0.4**2) / 2
    coefficients, errors = resolution.straight_line(x, y)
    assert coefficients.tolist() == pytest.approx([slope, intercept])
    expected = [np.sqrt(variance / 5), np.sqrt(variance * (1 / 4 + 1.5**2 / 5))]
    assert errors.tolist() == pytest.approx(expected)


def test_the_front_of_the_papers_global_slip_is_slower_than_long_waves():
    row = pd.DataFrame(summarise([simulate(Chain.from_slider(), until="global slip")])).assign(n_blocks=10)
    [speed] = resolution.front_speed(row.rename(columns=WITH_UNITS), 0.1)
    assert speed == pytest.approx(0.09 / row["crossing_time"][0])
    assert 1000 < speed < 1443
