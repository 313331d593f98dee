"""What the measures of a scene say of its chain and of its first global slip."""

import math

import pytest

from precursors import Chain, simulate
from precursors.model.statics import maximal_strain_positions
from precursors.reproduction.scene_numbers import measures_table, residual_strain

# Sums and quotients of ten numbers in double precision.
ROUNDING = 1e-12


@pytest.fixture(scope="module")
def measures():
    runs = {theta: simulate(Chain.from_slider(theta=theta), 4.0) for theta in ("-5/6", "0")}
    return measures_table(runs).set_index("scene")


def test_parameters_are_those_of_the_paper(measures):
    own = measures.loc["-5/6"]
    assert own["block_mass_kg"] == pytest.approx(0.0012, rel=ROUNDING)
    assert own["stiffness_N_per_m"] == pytest.approx(25e6, rel=ROUNDING)
    assert own["first_normal_load_N"] == pytest.approx(440 / 6, rel=ROUNDING)
    assert own["last_normal_load_N"] == pytest.approx(40 / 6, rel=ROUNDING)
    assert own["normal_load_N"] == pytest.approx(400, rel=ROUNDING)


def test_events_begin_at_block_1_and_some_blocks_slide_backward(measures):
    assert (measures["share_of_events_from_block_1"] == 1).all()
    assert measures["backward_releases"].to_dict() == {"-5/6": 2, "0": 0}


def test_the_residual_strain_of_eq_12_is_the_largest():
    chain = Chain.from_slider(theta="5/6")
    for share in (1.0, 0.5):
        run = simulate(chain, 1e-6, start_positions=share * maximal_strain_positions(chain))
        assert residual_strain(run, 0.0) == pytest.approx(share, rel=ROUNDING)


def test_without_a_global_slip_there_is_no_strain_at_it():
    row = measures_table({"short": simulate(Chain.from_slider(), 0.1)}).iloc[0]
    assert math.isnan(row["residual_strain"])
    assert math.isnan(row["share_of_events_from_block_1"])
