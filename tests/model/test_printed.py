"""The numbers that the paper prints agree with each other, and nearly with our runs."""

import pytest
from reference.goldens import SCENES

from precursors import Chain, simulate
from precursors.analysis.slips import apparent_friction, slip_table
from precursors.model import printed

NEAR = 0.006  # our mu_sapp are 0.484 to 0.492


@pytest.mark.parametrize("scene", SCENES)
def test_a_scene_has_the_printed_number_of_events_and_nearly_the_printed_mu_sapp(scene):
    run = simulate(Chain.from_slider(theta=SCENES[scene]), until="global slip")
    found, paper = apparent_friction(slip_table(run)), printed.SCENES[scene]
    assert found.events_counted == paper["events_counted"]
    assert found.mu_sapp == pytest.approx(paper["mu_sapp"], abs=NEAR)


def test_load_cells_and_first_global_slip_are_those_of_one_experiment():
    assert sum(printed.CELL_LOADS_N) == Chain.from_slider().normal_load
    assert pytest.approx(printed.MU_SAPP * 400.0, rel=0.03) == printed.FIRST_GLOBAL_SLIP_N
