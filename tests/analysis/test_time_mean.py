"""The time mean of F_X is mu_k F_Z, to what is stored and what slides backward."""

import numpy as np
import pytest

from precursors import Chain, simulate
from precursors.analysis.load_curve import TOLERANCE_N
from precursors.analysis.mean_load import backward_slip, mean_load

CURVE = TOLERANCE_N / 400.0  # of the mean, over F_Z


@pytest.mark.parametrize("end", [2.0, 2.8904, 2.9])
def test_any_window_obeys_the_balance_also_within_a_slip(end):
    """Up to 2 s all work is stored; the first global slip lasts from 2.8902 to
    2.8907 s."""
    chain = Chain.from_slider(theta="5/6")
    found = mean_load(simulate(chain, 3.0), 0.0, end)
    assert found.stored < -0.1
    assert found.mean == pytest.approx(
        chain.mu_k + found.stored + found.backward, abs=CURVE
    )


def test_backward_slip_is_the_way_back_of_each_block():
    run = simulate(Chain.from_slider(theta="5/6"), 4.0)
    backward = run.transitions["mode"] == -1
    assert backward.any()
    slid = backward_slip(run, 0.0, run.duration)
    moving = set(run.transitions["block"][backward] - 1)
    assert set(np.flatnonzero(slid > 0.0)) == moving
    assert (slid >= 0.0).all()
