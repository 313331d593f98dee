"""The change of R equals the work of the drive beyond kinetic friction, less the loss
by backward sliding."""

from dataclasses import replace

import numpy as np
import pytest

from precursors import Chain, find_precursors, find_slips, simulate
from precursors.analysis.balance import backward_slip, balance, distance, drive_work

# Error of R, which is 0.02 J at the start, in sums over some 30,000 points.
ROUNDING_J = 1e-11
# Number of samples of a path, and its relative error: sampling cuts off turning points.
TIMES = 400_001
CUT = 1e-3


@pytest.mark.parametrize("end", [2.0, 2.8904, 2.9])
def test_balance_holds_in_any_window_even_within_a_slip(end):
    """The first global slip lasts from 2.8902 to 2.8907 s."""
    energy = balance(simulate(Chain.from_slider(theta="5/6"), 3.0), 0.3, end)
    assert energy.change < -0.01
    assert abs(energy.remainder) < ROUNDING_J
    assert energy.remainder == energy.change - energy.work + energy.backward


def test_distance_of_one_block_is_equal_before_and_after_a_slip():
    """R = (K V t - mu_k F_Z)^2/(2 K) up to the first slip, at K V t = mu_s F_Z; a slip
    reverses F_X - mu_k F_Z."""
    chain = Chain.from_slider(n_blocks=1)
    run = simulate(chain, 12.0)
    stiffness, rate = chain.drive_stiffness, chain.loading_rate
    before = (rate * 1.5 - chain.mu_k * chain.normal_load) ** 2 / (2 * stiffness)
    most = ((chain.mu_s - chain.mu_k) * chain.normal_load) ** 2 / (2 * stiffness)
    slips = find_slips(run)
    assert len(slips) > 2
    assert distance(run, [1.5])[0] == pytest.approx(before)
    assert distance(run, slips["onset"]) == pytest.approx(most)
    assert distance(run, slips["end"]) == pytest.approx(most)
    cycle = drive_work(run, slips["onset"])
    assert np.ptp(cycle) < ROUNDING_J


@pytest.mark.parametrize("mu_k", [0.1, 0.45])
def test_backward_sliding_lowers_r_by_the_work_along_its_path(mu_k):
    """The reference samples the path of each block and does not use transitions."""
    run = simulate(Chain.from_slider(theta="5/6", mu_k=mu_k, drive_velocity=1e-2), 0.1)
    steps = np.diff(run.at(np.linspace(0.0, run.duration, TIMES))[0], axis=0)
    back = -steps.clip(max=0.0).sum(axis=0)
    slid = backward_slip(run, 0.0, run.duration)
    assert slid.max() > 0.0
    np.testing.assert_allclose(slid, back, rtol=CUT, atol=CUT * slid.max())
    energy = balance(run, 0.0, run.duration)
    assert energy.backward == pytest.approx(2.0 * mu_k * run.chain.weights @ slid)
    assert abs(energy.remainder) < ROUNDING_J


def test_balance_holds_across_a_step_of_the_drive_velocity():
    """R is continuous where the velocity steps."""
    chain = Chain.from_slider(theta="-5/6")
    slow = simulate(chain, 3.0)
    state = slow.at([3.0])
    start = state[0][0] - chain.drive_velocity * 3.0
    fast = simulate(
        replace(chain, drive_velocity=1e-3),
        0.4,
        start_positions=start,
        start_velocities=state[1][0],
    )
    ends = [distance(slow, [0.0])[0], distance(fast, [0.4])[0]]
    parts = [balance(slow, 0.0, 3.0), balance(fast, 0.0, 0.4)]
    change = sum(part.work - part.backward for part in parts)
    assert ends[1] - ends[0] == pytest.approx(change, abs=ROUNDING_J)


def test_blocks_that_have_slid_obey_their_own_balance():
    """Until the onset of each event of Fig. 13, with W(L_p) instead of F_Z."""
    run = simulate(Chain.from_slider(n_blocks=20), until="global slip")
    counted = find_precursors(find_slips(run))
    chain = run.chain
    for onset, front in zip(counted["onset"], counted["front"], strict=True):
        before, after = distance(run, [0.0, onset], front)
        ahead = chain.mu_k * chain.weights[front:].sum()
        work = drive_work(run, [onset])[0] + ahead * chain.drive_velocity * onset
        back = 2.0 * chain.kinetic_friction @ backward_slip(run, 0.0, onset)
        assert after - before == pytest.approx(work - back, abs=ROUNDING_J)
        load = run.tangential_load([onset])[0]
        bound = np.sqrt(2.0 * chain.drive_stiffness * after)
        assert abs(load - chain.mu_k * chain.weights[:front].sum()) <= bound
