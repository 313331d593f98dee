"""Predicted errors of a run, compared with a proof: they are never too small, and not
uselessly large."""

import numpy as np
import pytest
from chains import SLIDER, first_transitions
from places import CERTIFICATES

from precursors import certify, simulate
from precursors.analysis import horizon as module
from precursors.analysis.horizon import (
    PredictedErrors,
    horizon,
    neighbours,
    predicted_errors,
)
from precursors.benchmark.compare import Comparison, Truth, compare
from precursors.proof import Certificate, ExactChain
from precursors.solver.run import Run

CHAINS = sorted(path.name.split(".")[0] for path in CERTIFICATES.glob("*.json.gz"))
TOLERANCE = 1e-9  # s
TOLERANCES = [1e-15, 1e-13, 1e-11, 1e-9, 1e-7, 1e-5]  # s
# Largest ratio of an actual error to the predicted one; 0.7 is the largest known.
OPTIMISM = 2.0
# Smallest ratio of a predicted error to the actual one on a chain, at most; it is up to
# 10 on the chains below.
PESSIMISM = 30.0
# Relative error of the time of a near standstill, which a neighbouring run detects.
NEAR = 0.02


def beside_proof(certificate: Certificate) -> tuple[Run, Comparison, PredictedErrors]:
    """Return a run of the proved chain, its actual errors and its predicted ones."""
    truth = Truth.proved(certificate)
    start = [float(x) for x in certificate.start_positions]
    run = simulate(truth.run.chain, truth.run.duration, start_positions=start)
    return run, compare(run, truth), predicted_errors(run)


@pytest.mark.parametrize("name", CHAINS)
def test_predicted_errors_bound_true_errors_and_are_not_useless(name):
    certificate = Certificate.load(CERTIFICATES / f"{name}.json.gz")
    run, compared, predictions = beside_proof(certificate)
    n = compared.transitions_right
    known = np.isfinite(predictions.time_error)
    assert not known[n:].any()
    predicted = predictions.time_error[known]
    assert (compared.time_errors[known[:n]] <= OPTIMISM * predicted).all()
    assert not predictions.order_known_until > compared.first_difference
    for tolerance in TOLERANCES:
        horizon = predictions.horizon(tolerance)
        before = np.count_nonzero(run.transitions["time"] < horizon)
        assert before <= n
        assert (compared.time_errors[:before] <= OPTIMISM * tolerance).all()
    moving = predicted[:n] > 0.0
    actual = np.maximum.accumulate(compared.time_errors[known[:n]])[moving]
    assert (actual / np.maximum.accumulate(predicted)[moving]).max() > 1 / PESSIMISM
    # The horizon is longer than half of the time for which the run is right.
    wrong = run.transitions["time"][:n][compared.time_errors > TOLERANCE]
    right_until = min(*wrong[:1], compared.first_difference, run.duration)
    horizon = predictions.horizon(TOLERANCE)
    assert horizon > right_until / 2
    if name == "fast_drive":  # loses the order in double precision, and says so before
        assert 0.1 < horizon < right_until < compared.first_difference < 0.2


def test_predicted_errors_hold_where_stops_are_nearly_missed():
    """Block 1 slides at nearly the speed of the drive, because friction hardly drops."""
    exact = ExactChain.from_slider(
        8, theta="0.6", drive_stiffness=19e6, drive_velocity="8e-3", mu_k="0.69973"
    )
    _, compared, predictions = beside_proof(certify(exact, "3e-4"))
    assert (compared.time_errors <= OPTIMISM * predictions.time_error).all()


@pytest.mark.parametrize(("miss", "is_lost"), [(1e-8, True), (1e-3, False)])
def test_near_standstill_within_the_error_ends_the_horizon(miss, is_lost, monkeypatch):
    monkeypatch.setattr(module, "EPS", 1e-9)
    chain = SLIDER(n_blocks=1, mu_k=0.70, drive_velocity=0.01)
    # About steady sliding the velocity swings from nearly 2 V down to `miss` V, half a
    # period later.
    start = {
        "start_positions": [-280.0 / 0.8e6],
        "start_velocities": [0.01 * (2.0 - miss)],
    }
    run = simulate(chain, 5e-4, **start)
    assert len(run.transitions) == 1
    until = predicted_errors(run).order_known_until
    half_period = np.pi * np.sqrt(chain.mass / chain.drive_stiffness)
    assert until == (pytest.approx(half_period, rel=NEAR) if is_lost else np.inf)


@pytest.mark.parametrize("load", [1e-13, 1e-14])
def test_load_hidden_by_rounding_ends_the_horizon_early(load):
    run = simulate(SLIDER(n_blocks=3, theta=1 - load), 1e-3)
    # At 1e-13 the run turns block 1 there, which should stick, and so do its neighbours.
    assert predicted_errors(run).order_known_until < run.transitions["time"][1]


def test_a_mirror_symmetric_start_ends_the_horizon_at_its_tie():
    start = [0, 0, 0, 1e-5, 0, 0, 0]
    run = simulate(SLIDER(n_blocks=7), 0.3, start_positions=start)
    # Blocks 2 and 6 are released at the same instant, after the three that move from
    # the start.
    assert set(run.transitions["block"][3:5]) == {2, 6}
    assert predicted_errors(run).horizon(1.0) <= run.transitions["time"][4]


def test_later_motion_does_not_change_the_horizon():
    chain = SLIDER(theta="5/6", drive_velocity=0.01)
    whole = predicted_errors(simulate(chain, 0.16))
    part = predicted_errors(simulate(chain, 0.05))
    assert np.array_equal(part.time_error, whole.time_error[: len(part.time_error)])
    for tolerance in TOLERANCES:
        expected = min(0.05, whole.horizon(tolerance))
        assert part.horizon(tolerance) == pytest.approx(expected, rel=1e-6)


def test_horizon_ends_at_the_first_error_beyond_the_tolerance():
    errors = PredictedErrors(
        np.array([1.0, 2.0, 2.1]), np.array([1e-12, 1e-3, 0.5]), 3.0, np.inf
    )
    ends = [errors.horizon(tolerance) for tolerance in (1e-13, 1e-9, 1e-3, 1e-2, 1.0)]
    assert ends == pytest.approx([1.0 - 1e-12, 2.0 - 1e-3, 2.0, 2.0, 3.0], rel=1e-15)


def test_a_tolerance_must_be_a_positive_number():
    with pytest.raises(ValueError, match="tolerance must be"):
        horizon(simulate(SLIDER(), 0.1), 0.0)


def test_error_of_the_last_transition_of_a_run_is_known():
    assert np.isfinite(
        predicted_errors(first_transitions(SLIDER(), 5)).time_error
    ).all()


def test_blocks_moving_at_the_start_have_no_error():
    run = simulate(SLIDER(), 0.01, start_velocities=np.full(10, 1e-3))
    error = predicted_errors(run).time_error
    assert (error[:10] == 0.0).all()
    assert (error[10:] > 0.0).all()


def test_weightless_block_stays_weightless_in_neighbours():
    others = neighbours(simulate(SLIDER(theta=-1), 0.1))
    assert {one.chain.weights[-1] for one in others} == {0.0}
