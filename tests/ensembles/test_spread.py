"""Members of the spread are the chains that their labels say, and are classified by the stated rule."""

import numpy as np
import pandas as pd
import pytest
from ensembles.studies import spread_of

from precursors import Chain
from precursors.ensembles.spread import RULES, robustness_table, spread_table
from precursors.ensembles.study import Study, run_members, start_of


def starts(study, query):
    return [start_of(member, study.seed) for member in study.members.query(query).to_dict("records")]


@pytest.mark.parametrize(("scene", "theta"), [("fig11", -5 / 6), ("fig10", 0.0), ("fig12", 5 / 6)])
def test_members_are_the_chains_that_their_labels_say(scene, theta):
    study, plain = spread_of(), Chain.from_slider(theta=theta)
    of_scene = f"scene == '{scene}' and "
    for chain, start in starts(study, of_scene + "perturbation == 'none'"):
        assert chain == plain
        assert not start.any()
    noisy = starts(study, of_scene + "perturbation == 'normal loads' and size == 0.01")
    for chain, _ in noisy:
        change = chain.weights / plain.weights - 1
        assert 0 < np.abs(change).max() <= 1e-2
        assert len(set(change)) == plain.n_blocks
    assert len({chain.weights.tobytes() for chain, _ in noisy}) == len(noisy) == 3
    for chain, _ in starts(study, of_scene + "perturbation == 'k'"):
        assert 0 < abs(chain.stiffness / plain.stiffness - 1) <= 1e-2
        assert np.array_equal(chain.weights, plain.weights)
    for chain, start in starts(study, of_scene + "perturbation == 'initial positions'"):
        assert chain == plain
        assert 0 < np.abs(start).max() <= 1e-2 * 0.7 * 400 / 10 / 25e6 * (1 + 1e-12)
    swept = study.members.query(of_scene + "question == 'theta' and perturbation != 'none'")["theta"]
    np.testing.assert_allclose(swept, theta + np.array([-0.0034, 0.0, 0.0034]), rtol=1e-12)


def test_the_spread_tells_unchanged_members_from_changed_ones():
    table = spread_table(run_members(spread_of()))
    found = table.set_index(["scene", "perturbation", "size", "quantity"]).sort_index()
    tiny = found.loc[("fig10", "normal loads", 1e-12)]
    assert (tiny["share_unchanged"] == 1.0).all()
    assert tiny.loc["mu_sapp", "q50"] == pytest.approx(0.48576, abs=1e-5)
    assert found.loc[("fig12", "normal loads", 1e-2, "mu_sapp"), "share_unchanged"] < 1.0
    assert found.loc[("fig12", "normal loads", 1e-2, "mu_sapp"), "largest"] > 0.5
    assert set(found["n"]) == {3}


def members_with(changes: dict[float, list[float]]) -> pd.DataFrame:
    """Members of one scene whose mu_sapp is as given for each size, all else unchanged."""
    alone = {"scene": "s", "question": "loads", "perturbation": "none", "size": 0.0, "mu_sapp": 0.5}
    rest = {"events_counted": 4, "n_events": 5, "time_s": 2.0, "reached": True}
    changed = [
        {**alone, **rest, "perturbation": "noise", "size": size, "mu_sapp": mu}
        for size, values in changes.items()
        for mu in values
    ]
    return pd.DataFrame([{**alone, **rest}, *changed])


@pytest.mark.parametrize(
    ("changes", "expected"),
    [
        ({1e-4: [0.5] * 20, 1e-2: [0.504] * 20}, "robust"),
        ({1e-4: [0.5] * 20, 1e-2: [0.5] * 19 + [0.6]}, "robust"),
        ({1e-4: [0.5] * 20, 1e-2: [0.5] * 18 + [0.6] * 2}, "sensitive"),
        ({1e-4: [0.5] * 20, 1e-2: [0.506] * 20}, "sensitive"),
        ({1e-4: [0.5] * 18 + [0.4] * 2, 1e-2: [0.5] * 20}, "fragile"),
        ({1e-4: [np.nan] * 20, 1e-2: [0.6] * 20}, "fragile"),
    ],
)
def test_a_number_is_classed_by_the_smallest_change_that_it_does_not_survive(changes, expected):
    classified = robustness_table(spread_table(members_with(changes))).set_index("quantity")
    assert classified.loc["mu_sapp", "class"] == expected
    assert classified.loc["mu_sapp", "rule"] == RULES[expected]
    assert classified.loc["events_counted", "class"] == "robust"


def test_the_scene_with_the_load_at_the_leading_edge_is_fragile():
    study = spread_of(members=20, loads=[1e-4], parameters=[1e-5])
    few = study.members.query(
        "scene in ['fig10', 'fig12'] and perturbation in ['none', 'normal loads', 'theta']"
    )
    table = spread_table(run_members(Study(few, study.until, study.seed)))
    classified = robustness_table(table).set_index(["scene", "quantity"])
    assert classified.loc[("fig12", "mu_sapp"), "class"] == "fragile"
    assert classified.loc[("fig10", "events_counted"), "class"] != "fragile"
