"""What the measures of a scene say of its chain and of its first global slip."""

import math

import pandas as pd
import pytest
from golden.small_tables import SMALL

from precursors import Chain, simulate
from precursors.model import printed
from precursors.model.statics import maximal_strain_positions
from precursors.reproduction.scene_numbers import measures_table, reproduction_tables, residual_strain
from precursors.support.files import read_table

# Sums and quotients of ten numbers in double precision.
ROUNDING = 1e-12


@pytest.fixture(scope="module")
def measures():
    runs = {theta: simulate(Chain.from_slider(theta=theta), 4.0) for theta in ("-5/6", "0")}
    return measures_table(runs).set_index("scene")


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


@pytest.mark.parametrize("name", ["mu_sapp", "reproduction"])
def test_the_papers_numbers_follow_from_the_slip_tables_that_are_kept(name):
    golden = SMALL.parent
    slips = {scene: read_table(golden / f"{scene}_slips.csv") for scene in printed.SCENES}
    found = reproduction_tables(slips, printed.SCENES)[name]
    kept = read_table(golden / f"{name}.csv")
    pd.testing.assert_frame_equal(found.astype(kept.dtypes), kept, rtol=ROUNDING)
