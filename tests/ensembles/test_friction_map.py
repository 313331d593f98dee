"""The chains of the map are what its axes say."""

import pytest
from ensembles.studies import study_of

from precursors.ensembles.studies import MAP
from precursors.ensembles.study import chain_of, run_members


def test_the_chains_of_the_map_are_what_its_axes_say():
    members = study_of(MAP, {"points": 36}).members
    assert len(members) == len(members[["theta", "friction_ratio"]].drop_duplicates()) == 36
    assert members[["theta", "friction_ratio"]].min().tolist() == pytest.approx([-0.95, 0.1])
    assert members[["theta", "friction_ratio"]].max().tolist() == pytest.approx([0.95, 0.95])
    for member in members.iloc[::7].to_dict("records"):
        chain = chain_of(member)
        assert chain.mu_k / chain.mu_s == pytest.approx(member["friction_ratio"])
        outer = chain.weights[[0, -1]]
        assert (outer[1] - outer[0]) / outer.sum() == pytest.approx(member["theta"])


def test_runs_of_the_map_go_on_after_the_first_global_slip():
    rows = run_members(study_of(MAP, {"points": 9}))
    assert rows["reached"].all()
    assert (rows["n_global"] > 1).all()
