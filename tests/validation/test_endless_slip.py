"""A slip that does not end is a motion of the model: audited, and proved over a stretch."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from chains import SLIDER, audited

from precursors import Run, certify, find_slips, simulate

N_BLOCKS = 130
# State in the tenth run of N_BLOCKS blocks among the first 60 of the study, 5 ms after a slip began.
STATE = Path(__file__).with_name("endless_slip.csv")
LASTED = 0.005  # [s]: no slip with an end lasted so long in 240 runs of 80 to 200 blocks
STRETCH = 1e-4  # [s]: one and a half times the way of a sound wave along the chain
TIME = 1e-15  # [s]: rounding, over the stretch


def run(duration: float, longest_slip: float | None = None) -> Run:
    """The motion from that state on."""
    state = pd.read_csv(STATE)
    chain = replace(SLIDER(N_BLOCKS), weights=state["weight_N"].to_numpy())
    start = {"start_positions": state["position_m"], "start_velocities": state["velocity_m_s"]}
    return simulate(chain, duration, longest_slip=longest_slip, **start)


@pytest.fixture(scope="module")
def stretch() -> Run:
    """A stretch that can be proved."""
    return run(STRETCH)


def test_the_run_stops_in_the_slip_that_lasts_so_long():
    endless = run(duration=1.0, longest_slip=LASTED)
    slip = find_slips(endless).iloc[-1]
    assert endless.duration == pytest.approx(LASTED, rel=1e-9)
    assert slip["onset"] == 0.0
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
