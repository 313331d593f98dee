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


def runs_of(laws: dict[str, np.ndarray], n_blocks: np.ndarray) -> pd.DataFrame:
    """Three runs for each N, one below the law, one on it, one above, and one without a global slip."""
    runs = {
        "scene": "s",
        "n_blocks": n_blocks,
        "crossing_time_s": 1e-4,
        "time_s": 2.0,
        **laws,
        "reached": True,
    }
    on_law = pd.DataFrame(runs)
    names = list(laws)
    others = [on_law.assign(**{name: factor * on_law[name] for name in names}) for factor in (0.9, 1.1)]
    never = on_law.assign(**dict.fromkeys(names, 9e9), reached=False)
    return pd.concat([on_law, *others, never], ignore_index=True)


def test_an_exact_law_is_carried_on_exactly_and_has_an_interval():
    n_blocks = np.array([5, 20, 40, 80, 160])
    mu_sapp = 0.45 + 0.5 / n_blocks
    mu_sapp[0] = 9.9  # below the smallest N that takes part
    runs = runs_of({"mu_sapp": mu_sapp}, n_blocks)
    found = resolution.extrapolation_table(runs, 0.1, from_n_blocks=20).set_index("quantity").loc["mu_sapp"]
    assert found[["a", "b"]].tolist() == pytest.approx([0.45, 0.5], rel=1e-12)
    assert found["a_low"] < 0.45 < found["a_high"]
    assert found["n_points"] == 4


def test_bootstrap_intervals_hold_limits_and_exponents_in_95_of_100_cases(monkeypatch):
    """On made-up runs whose medians obey the laws. Of medians, such intervals are a little too long."""
    monkeypatch.setattr(resolution, "SAMPLES", 500)
    scenes, runs, n_blocks = 300, 15, np.array([20, 40, 80, 160])
    n = np.repeat(np.tile(n_blocks, scenes), runs)
    noise = np.random.default_rng(2).normal(size=(4, len(n)))
    made_up = {"mu_sapp": 0.45 + 0.5 / n + 0.01 * noise[0], "time_s": 2.0 + 3.0 / n + 0.1 * noise[1]}
    made_up |= {"events_counted": n**1.5 * np.exp(0.2 * noise[2]), "n_events": n * np.exp(0.2 * noise[3])}
    members = pd.DataFrame({"scene": np.arange(len(n)) // (4 * runs), "n_blocks": n, **made_up})
    members = members.assign(crossing_time_s=1e-4, reached=True)
    true = {"mu_sapp": 0.45, "time_s": 2.0, "events_counted": 1.5, "n_events": 1.0}
    limits = resolution.extrapolation_table(members, 0.1, 20).rename(
        columns={"a_low": "low", "a_high": "high"}
    )
    found = pd.concat([limits, resolution.exponents_table(members)]).query("quantity in @true")
    held = found["quantity"].map(true).between(found["low"], found["high"])
    assert len(held) == scenes * (2 + 2 * 3)
    # Three standard errors of so many cases.
    assert 0.95 - 3 * np.sqrt(0.95 * 0.05 / len(held)) < held.mean() < 0.985


def test_an_exponent_is_that_of_each_octave_and_runs_without_a_global_slip_do_not_count():
    n_blocks = np.array([5, 10, 15, 20])
    counts = np.array([10.0, 20.0, 20.0, 20.0])
    runs = runs_of({"n_events": counts, "events_counted": counts}, n_blocks)
    table = resolution.exponents_table(runs).query("quantity == 'n_events'").set_index("n_blocks")
    assert table["exponent"].to_dict() == pytest.approx({5: 1.0, 10: 0.0})
    assert (table["low"] < table["exponent"]).all()
    assert (table["exponent"] < table["high"]).all()


def test_both_readings_of_global_slip_are_told_apart_and_every_run_is_counted():
    runs = {"n_blocks": 4, "sliding_each": [4, 2, 2, 0], "reached": [True, True, False, False]}
    runs |= {"n_events": [5, 5, 9, 9], "n_events_each": [5, 3, 3, 9]}
    runs |= {"mu_sapp": [0.5, 0.5, np.nan, np.nan], "mu_sapp_each": [0.5, 0.4, 0.4, np.nan]}
    row = resolution.readings_table(pd.DataFrame(runs).assign(scene="s", theta=0.0)).iloc[0]
    assert (row["runs"], row["without_global_slip"], row["earlier"]) == (4, 2, 0.5)
    assert (row["events_at_once"], row["events_each"], row["pulse_share"]) == (5, 3, 0.5)
    # Two of four: Clopper and Pearson's tables.
    assert [row["earlier_low"], row["earlier_high"]] == pytest.approx([0.0676, 0.9324], abs=1e-4)


def test_the_papers_run_is_predictable_and_thirty_blocks_with_a_heavy_trailing_edge_are_not():
    """At N = 30 and theta = 5/6 the horizon of the run is shorter than its first global slip."""
    slider = {"s": {**CONFIG["chain"], "theta": 5 / 6}}
    table = resolution.predictability_table(slider, [10, 30], 10.0, 1e-9)
    assert table["predictable"].tolist() == [True, False]


def test_the_front_of_the_papers_global_slip_is_slower_than_long_waves():
    row = pd.DataFrame(summarise([simulate(Chain.from_slider(), until="global slip")])).assign(n_blocks=10)
    [speed] = resolution.front_speed(row.rename(columns=WITH_UNITS), 0.1)
    assert speed == pytest.approx(0.09 / row["crossing_time"][0])
    assert 1000 < speed < 1443
