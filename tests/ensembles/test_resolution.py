"""Each number is tabulated for every N, and extrapolated to infinite N."""

import numpy as np
import pandas as pd
import pytest
from ensembles.studies import CONFIG

from precursors import Chain, simulate
from precursors.analysis.summary import summarise
from precursors.ensembles import resolution
from precursors.ensembles.study import WITH_UNITS


def test_an_exact_law_is_extrapolated_exactly_from_the_runs_with_noise_and_a_global_slip():
    """Three runs for each N, one below the law, one on it, one above; others do not
    count."""
    laws = pd.DataFrame(
        {"n_blocks": [20, 40, 80, 160], "scene": "s", "draw": 1, "reached": True}
    )
    laws = laws.assign(
        mu_sapp=0.45 + 0.5 / laws["n_blocks"], time_s=2.0, front_speed_m_per_s=1e3
    )
    others = [{"n_blocks": 5}, {"draw": 0}, {"reached": False}]
    members = [
        laws.assign(mu_sapp=factor * laws["mu_sapp"]) for factor in (0.9, 1.0, 1.1)
    ]
    members += [laws.assign(mu_sapp=9.9, **other) for other in others]
    table = resolution.extrapolation_table(
        pd.concat(members), from_n_blocks=20, given={"time_s": 1.9}
    ).set_index("quantity")
    found = table.loc["mu_sapp"]
    assert found[["a", "b"]].tolist() == pytest.approx([0.45, 0.5], rel=1e-12)
    assert found["a_low"] < 0.45 < found["a_high"]
    assert found["n_points"] == 4
    assert found["misfit"] == pytest.approx(0.0, abs=1e-12)
    # A limit that is given leaves the slope: 0.1 = b/N by least squares over 1/N.
    given = table.loc["time_s"]
    assert given[["a_low", "a", "a_high"]].tolist() == [1.9] * 3
    inverse = 1.0 / laws["n_blocks"]
    slope = 0.1 * inverse.sum() / (inverse**2).sum()
    assert given["b"] == pytest.approx(slope, rel=1e-12)
    assert given["misfit"] == pytest.approx(0.1 - slope / 160, rel=1e-12)
    assert table["given"].tolist() == [False, True, False]


def test_bootstrap_intervals_hold_limits_in_95_of_100_cases(monkeypatch):
    """On made-up runs whose medians obey the laws. Of medians, such intervals are a
    little too long."""
    monkeypatch.setattr(resolution, "SAMPLES", 500)
    scenes, runs, n_blocks = 300, 15, np.array([20, 40, 80, 160])
    n = np.repeat(np.tile(n_blocks, scenes), runs)
    noise = np.random.default_rng(2).normal(size=(2, len(n)))
    made_up = {
        "mu_sapp": 0.45 + 0.5 / n + 0.01 * noise[0],
        "time_s": 2.0 + 3.0 / n + 0.1 * noise[1],
    }
    members = pd.DataFrame(
        {"scene": np.arange(len(n)) // (4 * runs), "n_blocks": n, **made_up}
    )
    members = members.assign(front_speed_m_per_s=1e3, reached=True, draw=1)
    found = resolution.extrapolation_table(members, 20, {}).query(
        "quantity != 'front_speed_m_per_s'"
    )
    held = (
        found["quantity"]
        .map({"mu_sapp": 0.45, "time_s": 2.0})
        .between(found["a_low"], found["a_high"])
    )
    assert len(held) == scenes * 2
    # Three standard errors of so many cases.
    assert 0.95 - 3 * np.sqrt(0.95 * 0.05 / len(held)) < held.mean() < 0.985


def test_the_papers_run_is_predictable_and_thirty_blocks_with_a_heavy_trailing_edge_are_not():
    """At N = 30 and theta = 5/6 the horizon of the run is shorter than its first global
    slip."""
    slider = {"s": {**CONFIG["chain"], "theta": 5 / 6}}
    table = resolution.predictability_table(slider, [10, 30], 10.0, 1e-9)
    assert table["predictable"].tolist() == [True, False]


def test_the_front_of_the_papers_global_slip_is_slower_than_long_waves():
    run = simulate(Chain.from_slider(), until="global slip")
    row = summarise([run]).assign(n_blocks=10)
    [speed] = resolution.with_front_speed(row.rename(columns=WITH_UNITS), 0.1)[
        "front_speed_m_per_s"
    ]
    assert speed == pytest.approx(0.09 / row["crossing_time"][0])
    assert 1000 < speed < resolution.wave_speed(CONFIG["chain"])
