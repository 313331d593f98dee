"""The table of the paper's numbers, and the residual strain in known states."""

import math

import pytest

from maegawa2010.paper.scene_numbers import reproduction_table, residual_strain
from precursors import Chain, find_slips, simulate, slip_table
from precursors.model.statics import maximal_strain_positions

# Rounding of sums and quotients of ten numbers in double precision.
ROUNDING = 1e-12


def test_the_residual_strain_of_eq_12_is_one():
    chain = Chain.from_slider(theta="5/6")
    run = simulate(chain, 0.001, start_positions=maximal_strain_positions(chain))
    assert residual_strain(run) == pytest.approx(1.0, rel=ROUNDING)


def test_one_block_has_no_residual_strain_and_two_have():
    one, two = (simulate(Chain.from_slider(n), 10.0) for n in (1, 2))
    assert math.isnan(residual_strain(one))
    assert 0.0 < residual_strain(two) < 1.0


def test_a_run_without_a_slip_has_no_numbers():
    run = simulate(Chain.from_slider(), 0.1)
    table = reproduction_table({"calm": slip_table(run)}, {"calm": {}})
    assert find_slips(run).empty
    assert math.isnan(residual_strain(run))
    assert table["reproduced"].isna().sum() == 3
