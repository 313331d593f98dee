"""Global slips of a long run."""

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
