"""A slip that does not end is a motion of the model: audited, and proved over a stretch."""

from dataclasses import replace

import numpy as np
import pytest
from chains import SLIDER, audited

from precursors import Run, certify, find_slips, simulate

N_BLOCKS = 130
SEED = (2015, 0, 9)  # the tenth run of N_BLOCKS blocks among the first 60: slip began and did not end
LASTED = 0.005  # [s]: no slip with an end lasted so long in 240 runs of 80 to 200 blocks
STRETCH = 1e-4  # [s]: one and a half times the way of a sound wave along the chain
TIME = 1e-15  # [s]: rounding, over the stretch


@pytest.fixture(scope="module")
def endless() -> Run:
    """A run up to a slip that has lasted long."""
    chain = SLIDER(N_BLOCKS)
    random = np.random.default_rng(np.random.SeedSequence(SEED[0], spawn_key=SEED[1:]))
    noisy = replace(chain, weights=chain.weights * (1 + 1e-3 * random.uniform(-1, 1, N_BLOCKS)))
    return simulate(noisy, until="global slip", longest_slip=LASTED)


@pytest.fixture(scope="module")
def stretch(endless) -> Run:
    """The motion from the end of that run on."""
    (positions,), (velocities,) = endless.at([endless.duration])
    # The drive is at 0 when a run begins.
    positions = positions - endless.chain.drive_velocity * endless.duration
    return simulate(endless.chain, STRETCH, start_positions=positions, start_velocities=velocities)


def test_the_run_stops_in_the_slip_that_lasts_so_long(endless):
    slip = find_slips(endless).iloc[-1]
    assert endless.duration - slip["onset"] == pytest.approx(LASTED, rel=1e-9)
    assert np.isnan(slip["end"])
    assert slip["n_slid"] == N_BLOCKS
    assert slip["n_simultaneous"] < N_BLOCKS
    assert not find_slips(endless)["is_global"].any()


def test_the_load_stays_at_that_of_kinetic_friction(stretch):
    mu = stretch.transitions["tangential_load"] / stretch.chain.normal_load
    np.testing.assert_allclose(mu, stretch.chain.mu_k, rtol=0, atol=1e-3)


def test_a_stretch_is_a_motion_of_the_model(stretch):
    audited(stretch)


def test_a_stretch_is_proved(stretch):
    pytest.importorskip("flint")
    start = {"start_positions": stretch.start_positions, "start_velocities": stretch.start_velocities}
    proof = certify(stretch.chain, STRETCH, **start)
    found = stretch.transitions
    assert proof.tie is None
    assert len(proof.transitions) > 2 * N_BLOCKS  # the pulse passed each block
    assert [(t.block, t.mode) for t in proof.transitions] == found[["block", "mode"]].tolist()
    times = [float(t.time.midpoint) for t in proof.transitions]
    np.testing.assert_allclose(found["time"], times, rtol=0, atol=TIME)
