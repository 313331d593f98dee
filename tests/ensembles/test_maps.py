"""The chains of a map are what its axes say."""

import itertools

import pytest
from ensembles.studies import CONFIG, study_of

from precursors.ensembles.catalogue import MAPS
from precursors.ensembles.maps import PARAMETERS, places_of
from precursors.ensembles.study import run_members, start_of

# What a parameter is of a chain, apart from the code of the maps.
OF_CHAIN = {
    "theta": lambda chain: (chain.weights[-1] - chain.weights[0]) / (chain.weights[-1] + chain.weights[0]),
    "friction_ratio": lambda chain: chain.mu_k / chain.mu_s,
    "n_blocks": lambda chain: chain.n_blocks,
    "stiffness_ratio": lambda chain: chain.drive_stiffness / chain.stiffness,
    "drive_velocity": lambda chain: chain.drive_velocity,
}


@pytest.mark.parametrize(("x", "y"), MAPS.values())
def test_the_chains_of_a_map_are_what_its_axes_say(x, y):
    members = study_of(f"map_{x}_{y}", {"points": 36}).members
    assert len(members) == len(members[[x, y]].drop_duplicates()) == 36
    for name in (x, y):
        assert members[name].min() == pytest.approx(PARAMETERS[name].low)
        assert members[name].max() == pytest.approx(PARAMETERS[name].high)
    for member, name in itertools.product(members.iloc[::7].to_dict("records"), (x, y)):
        chain, start = start_of(member)
        assert not start.any()
        assert OF_CHAIN[name](chain) == pytest.approx(member[name], rel=1e-12, abs=1e-12)


def test_runs_of_a_map_go_on_after_the_first_global_slip():
    rows = run_members(study_of("map_theta_friction_ratio", {"points": 9}))
    assert rows["reached"].all()
    assert (rows["n_global"] > 1).all()


def test_the_papers_slider_has_its_place_on_every_map():
    slider = {**CONFIG["chain"], "theta": 5 / 6}
    expected = {"theta": 5 / 6, "friction_ratio": 0.45 / 0.70, "n_blocks": 10}
    expected |= {"stiffness_ratio": 0.8e6 / 25e6, "drive_velocity": 1e-4}
    for x, y in MAPS.values():
        assert places_of([slider], x, y) == [pytest.approx((expected[x], expected[y]))]
