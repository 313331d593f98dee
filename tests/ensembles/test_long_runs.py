"""Global slips of a long run."""

import pandas as pd
import pytest

from precursors import Chain, simulate
from precursors.ensembles import long_runs


def test_global_slips_of_a_long_run_begin_at_the_largest_load_since_the_one_before():
    run = simulate(Chain.from_slider(), duration=30.0)
    table = long_runs.global_slips(run)
    assert len(table) > 30
    first = run.transitions[run.transitions["time"] <= table["onset_s"][0]]
    assert table["load_before_N"][0] == first["tangential_load"].max()
    assert (table["load_after_N"] < table["load_before_N"]).all()
    statistics = long_runs.long_run_statistics(table.assign(scene="s")).iloc[0]
    assert statistics["n"] == len(table) - 1
    assert statistics["mu_first"] == pytest.approx(0.48576, abs=1e-5)
    assert statistics["least"] <= statistics["q05"] <= statistics["mean"] <= statistics["largest"]


def test_statistics_are_of_the_slips_after_the_first_by_hand():
    mu = [0.9, *(0.40 + 0.01 * k for k in range(21))]
    table = pd.DataFrame({"scene": "s", "onset_s": [2.0 * k for k in range(22)], "mu": mu})
    row = long_runs.long_run_statistics(table).iloc[0].drop("scene").to_dict()
    deviation = 0.01 * (21 * 22 / 12) ** 0.5  # of the numbers 1 to 21
    expected = {"mu_first": 0.9, "n": 21, "mean": 0.5, "mean_error": deviation / 21**0.5}
    expected |= {"deviation": deviation, "least": 0.4, "largest": 0.6, "mean_interval_s": 2.0}
    expected |= {"q05": 0.41, "q25": 0.45, "q50": 0.5, "q75": 0.55, "q95": 0.59}
    assert row == pytest.approx(expected, rel=1e-12)
