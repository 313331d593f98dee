"""Each number is tabulated for every N, and extrapolated to infinite N."""

import numpy as np
import pandas as pd
import pytest
from ensembles.studies import CONFIG, study_of

from precursors import Chain, simulate
from precursors.analysis.summary import summarise
from precursors.ensembles import resolution
from precursors.ensembles.study import WITH_UNITS

SETTINGS = {"seed": 1, "n_blocks": [2, 10, 12], "runs": [6, 9, 3]}


def test_each_chain_is_run_once_without_noise_and_else_with_it_but_for_the_scenes_own_n():
    study = study_of("resolution_members", SETTINGS)
    runs = study.members.groupby(["scene", "n_blocks"])["load_noise"]
    assert runs.size().to_dict() == {(scene, n): r for scene in CONFIG["fig13"] for n, r in ((2, 7), (12, 4))}
    assert all((noise == 0.0).sum() == 1 for _, noise in runs)


def test_both_counts_are_told_apart_and_compared_with_the_uniform_loading():
    runs = {"scene": ["s"] * 3 + ["even"] * 3, "events_to_global_slip": [60, 50, 70, 20, 20, 20]}
    runs |= {"events_counted": [15, 14, 99, 10, 10, 10], "reached": [True, True, False] + [True] * 3}
    members = pd.DataFrame(runs).assign(n_blocks=10, draw=1, theta=lambda t: 1.0 * (t["scene"] == "s"))
    row = resolution.counts_table(members, "even").set_index("scene").loc["s"]
    assert (row["runs"], row["events_to_global_slip"], row["events_counted"]) == (2, 55, 14.5)
    assert row["events_to_global_slip_over_uniform"] == pytest.approx(2.75)
    assert row["events_counted_over_uniform"] == pytest.approx(1.45)
    assert row["share_counted"] == pytest.approx((15 / 60 + 14 / 50) / 2)
    assert row["counted_per_block"] == pytest.approx(1.45)


def runs_of(laws: dict[str, np.ndarray], n_blocks: np.ndarray) -> pd.DataFrame:
    """Three runs for each N, one below the law, one on it, one above, and one without a global slip."""
    runs = {
        "scene": "s",
        "n_blocks": n_blocks,
        "front_speed_m_per_s": 1e3,
        "time_s": 2.0,
        **laws,
        "reached": True,
        "draw": 1,
    }
    on_law = pd.DataFrame(runs)
    names = list(laws)
    others = [on_law.assign(**{name: factor * on_law[name] for name in names}) for factor in (0.9, 1.1)]
    never = on_law.assign(**dict.fromkeys(names, 9e9), reached=False)
    return pd.concat([on_law, *others, never], ignore_index=True)


def test_an_exact_law_is_extrapolated_exactly_and_has_an_interval():
    n_blocks = np.array([5, 20, 40, 80, 160])
    mu_sapp = 0.45 + 0.5 / n_blocks
    mu_sapp[0] = 9.9  # below the smallest N that takes part
    runs = runs_of({"mu_sapp": mu_sapp}, n_blocks)
    found = resolution.extrapolation_table(runs, from_n_blocks=20).set_index("quantity").loc["mu_sapp"]
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
    made_up |= {
        "events_counted": n**1.5 * np.exp(0.2 * noise[2]),
        "events_to_global_slip": n * np.exp(0.2 * noise[3]),
    }
    members = pd.DataFrame({"scene": np.arange(len(n)) // (4 * runs), "n_blocks": n, **made_up})
    members = members.assign(front_speed_m_per_s=1e3, reached=True, draw=1)
    true = {"mu_sapp": 0.45, "time_s": 2.0, "events_counted": 1.5, "events_to_global_slip": 1.0}
    limits = resolution.extrapolation_table(members, 20).rename(columns={"a_low": "low", "a_high": "high"})
    found = pd.concat([limits, resolution.exponents_table(members)]).query("quantity in @true")
    held = found["quantity"].map(true).between(found["low"], found["high"])
    assert len(held) == scenes * (2 + 2 * 3)
    # Three standard errors of so many cases.
    assert 0.95 - 3 * np.sqrt(0.95 * 0.05 / len(held)) < held.mean() < 0.985


def test_an_exponent_is_that_of_each_octave_and_runs_without_a_global_slip_do_not_count():
    n_blocks = np.array([5, 10, 15, 20])
    counts = np.array([10.0, 20.0, 20.0, 20.0])
    runs = runs_of({"events_to_global_slip": counts, "events_counted": counts}, n_blocks)
    table = (
        resolution.exponents_table(runs).query("quantity == 'events_to_global_slip'").set_index("n_blocks")
    )
    assert table["exponent"].to_dict() == pytest.approx({5: 1.0, 10: 0.0})
    assert (table["low"] < table["exponent"]).all()
    assert (table["exponent"] < table["high"]).all()


def test_the_papers_run_is_predictable_and_thirty_blocks_with_a_heavy_trailing_edge_are_not():
    """At N = 30 and theta = 5/6 the horizon of the run is shorter than its first global slip."""
    slider = {"s": {**CONFIG["chain"], "theta": 5 / 6}}
    table = resolution.predictability_table(slider, [10, 30], 10.0, 1e-9)
    assert table["predictable"].tolist() == [True, False]


def test_the_front_of_the_papers_global_slip_is_slower_than_long_waves():
    row = pd.DataFrame(summarise([simulate(Chain.from_slider(), until="global slip")])).assign(n_blocks=10)
    [speed] = resolution.with_front_speed(row.rename(columns=WITH_UNITS), 0.1)["front_speed_m_per_s"]
    assert speed == pytest.approx(0.09 / row["crossing_time"][0])
    assert 1000 < speed < resolution.wave_speed(CONFIG["chain"])
