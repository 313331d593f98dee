"""The larger models with more and more blocks: runs of its chain, and statistics of the runs."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest
from chains import SLIDER

from precursors import find_precursors, find_slips, simulate
from precursors.hierarchy.larger import LargerChain
from precursors.hierarchy.larger_resolution import (
    loadings_table,
    numbers,
    resolution_models_table,
    run_models,
    with_additions,
    with_noise,
)
from precursors.hierarchy.models import Motion

SETTINGS = {
    "seed": 2013,
    "theta": "1/3",
    "n_blocks": [4, 10],
    "noise": 1e-3,
    "runs": 6,
    "models": {
        "plain": {},
        "material": {"relaxation_time": 1e-6},
        "soft": {"interface_stiffness": 25e6, "most_blocks": 4},
        "both": {"interface_stiffness": 25e6, "viscosity": 54.77},
    },
}


@pytest.fixture(scope="module")
def runs() -> pd.DataFrame:
    return run_models({"mu_k": 0.4}, SETTINGS)


def test_each_model_has_its_runs_at_each_n_of_its_own(runs):
    counted = runs[runs["quantity"] == "mu_sapp"].groupby(["model", "n_blocks"], sort=False).size()
    assert counted.to_dict() == {
        **{(model, n): 6 for model in ("plain", "material", "both") for n in (4, 10)},
        ("soft", 4): 6,
    }


def test_the_table_has_the_values_of_each_model_and_the_statistics_of_its_runs(runs):
    table = resolution_models_table(runs)
    assert not table.duplicated(["model", "n_blocks", "quantity"]).any()
    rows = table.set_index(["model", "n_blocks", "quantity"]).sort_index()
    assert set(rows.loc["material", "viscous_time_s"]) == {1e-6}
    assert set(rows.loc["material", "viscosity_N_s_per_m"]) == {0.0}
    assert set(rows.loc["both", "interface_stiffness_N_per_m"]) == {25e6}
    assert (table["theta"] == 1 / 3).all()
    values = runs.query("model == 'both' and n_blocks == 10 and quantity == 'mu_sapp'")["value"]
    row = rows.loc[("both", 10, "mu_sapp")]
    assert row["q50"] == values.median()
    assert (row["q50_low"], row["q50_high"], row["n"]) == (values.min(), values.max(), 6)
    assert row["without_noise"] == values.iloc[0]


def test_the_runs_of_the_papers_chain_are_those_of_the_exact_solver(runs):
    run = simulate(SLIDER(10, theta="1/3", mu_k=0.4), until="global slip")
    slips = find_slips(run)
    found = runs.query("model == 'plain' and n_blocks == 10 and draw == 0").set_index("quantity")["value"]
    assert found["events_counted"] == len(find_precursors(slips))
    assert found["time_s"] == slips["onset"].iloc[-1]
    assert found["mu_sapp"] == run.transitions["tangential_load"].max() / 400.0
    last = run.transitions[run.transitions["time"] >= found["time_s"]]
    arrival = last["time"][(last["block"] == 10) & (last["mode"] != 0)][0]
    assert found["front_speed_m_per_s"] == pytest.approx(0.09 / (arrival - found["time_s"]), rel=1e-9)


def test_noise_is_the_same_in_every_model_and_none_in_the_first_run():
    chain = SLIDER(10)
    noisy = with_noise(chain, 3, SETTINGS)
    assert with_noise(chain, 0, SETTINGS) is chain
    assert (noisy.weights == with_noise(chain, 3, SETTINGS).weights).all()
    change = noisy.weights / chain.weights - 1.0
    assert 0.0 < abs(change).max() <= 1e-3
    assert not np.allclose(change, with_noise(chain, 4, SETTINGS).weights / chain.weights - 1.0)


@pytest.mark.parametrize("n_blocks", [4, 20])
def test_a_material_has_one_relaxation_time_and_an_interface_one_stiffness_at_every_n(n_blocks):
    chain = SLIDER(n_blocks)
    assert with_additions(chain, {"relaxation_time": 1e-6}) == LargerChain(chain, 1e-6 * chain.stiffness)
    assert with_additions(chain, {"interface_stiffness": 25e6}) == LargerChain(chain, 0.0, 25e6)
    assert with_additions(chain, {}) is chain


def test_a_front_that_starts_at_block_n_has_no_speed():
    slips = pd.DataFrame({"onset": [1.0], "end": [2.0], "front": [4], "is_global": [True]})
    found = numbers(Motion(4, slips, 0.5, front_arrival=1.0), length=0.1)
    assert np.isnan(found["front_speed_m_per_s"])
    assert found["time_s"] == 1.0


def test_loadings_that_matter_are_told_from_loadings_that_do_not():
    ask = {"n_blocks": 4, "runs": 6, "models": ["plain"]}
    same = loadings_table({}, SETTINGS, {**ask, "theta": [0, 1e-12]}).iloc[0]
    far = loadings_table({}, SETTINGS, {**ask, "theta": [-0.9, 0.9]}).iloc[0]
    assert (far["model"], far["n_blocks"], far["runs"]) == ("plain", 4, 6)
    assert far["least_high"] < far["largest_low"]
    assert far["p"] < 0.01
    assert same["least"] == pytest.approx(same["largest"], rel=1e-6)
    assert same["p"] > 0.5


def test_loadings_of_an_unknown_model_are_refused():
    with pytest.raises(ValueError, match=r"names of models of resolution, but are \['none'\]"):
        loadings_table({}, SETTINGS, {"n_blocks": 4, "runs": 6, "models": ["none"], "theta": [0, 0.5]})
