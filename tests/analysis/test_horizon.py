"""The errors that a run predicts are compared with the proof: they are never too small, and not useless."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
import yaml
from analysis.random_runs import random_chain
from chains import first_transitions
from reference import HeldOut, Transition, read_held_out

from precursors import Chain, Run, simulate
from precursors.accuracy.proof import Certificate
from precursors.accuracy.solver_vs_proof import Validation, error_table, summary, validate
from precursors.analysis import horizon as module
from precursors.analysis import lyapunov
from precursors.analysis.horizon import PredictedErrors, horizon, neighbours, predicted_errors
from precursors.analysis.lyapunov import lyapunov_exponent

ROOT = Path(__file__).parents[2]
CHAINS = list(yaml.safe_load((ROOT / "config.yaml").read_text())["accuracy"]["proved"])
TOLERANCES = [1e-15, 1e-13, 1e-11, 1e-9, 1e-7, 1e-5]  # s
# An actual error may be so many times the one predicted: 0.7 is the largest known.
OPTIMISM = 2.0
# Somewhere a prediction is no more than so many times the error: it is at most 10 times on every chain below.
PESSIMISM = 30.0
# A near miss is told where a neighbour first does not miss.
NEAR = 0.02
# Exponents [1/s] that the linearised motion gave for the scenes.
LINEARISED = {"-5/6": 1.657, "0": 2.164, "5/6": 1.909}


@pytest.fixture(scope="module", params=CHAINS)
def validation(request: pytest.FixtureRequest) -> Validation:
    path = ROOT / "workflow" / "certificates" / f"{request.param}.json.gz"
    return validate(Certificate.load(path))


def test_no_error_is_predicted_too_small_and_order_is_lost_only_where_it_is_unknown(
    validation: Validation,
) -> None:
    _, compared, predictions = validation
    n = compared.transitions_right
    known = np.isfinite(predictions.time_error)
    assert not known[n:].any()
    actual, predicted = compared.time_errors[known[:n]], predictions.time_error[known]
    assert (actual <= OPTIMISM * predicted).all()
    assert predictions.order_known_until < compared.first_difference or compared.first_difference == np.inf


def test_the_prediction_is_of_use(validation: Validation) -> None:
    facts = summary(validation, 1e-9)
    assert facts["largest_ratio"] > 1 / PESSIMISM
    # The tolerance is met for longer than half of the time that the run is really right.
    assert facts["horizon_s"] > facts["right_until_s"] / 2


@pytest.mark.parametrize("tolerance", TOLERANCES)
def test_up_to_the_horizon_all_transitions_hold(validation: Validation, tolerance: float) -> None:
    run, compared, predictions = validation
    before = np.count_nonzero(run.transitions["time"] < predictions.horizon(tolerance))
    assert before <= compared.transitions_right
    assert (compared.time_errors[:before] <= OPTIMISM * tolerance).all()


def test_the_error_table_grows_and_ends_with_the_run(validation: Validation) -> None:
    table = error_table(validation)
    assert table["time_s"].iloc[-1] == validation.run.transitions["time"][-1]
    for column in ("actual_error_s", "predicted_error_s"):
        assert (table[column].dropna().diff().dropna() >= 0).all()


@pytest.mark.parametrize("validation", ["fast_drive"], indirect=True)
def test_a_fast_drive_loses_the_order_in_double_precision_and_the_run_says_so_before(
    validation: Validation,
) -> None:
    facts = summary(validation, 1e-9)
    assert facts["order_lost_s"] < 0.2
    assert 0.1 < facts["horizon_s"] < facts["right_until_s"] < facts["order_lost_s"]
    assert facts["order_known_until_s"] < facts["order_lost_s"]


def held_out_run(case: HeldOut) -> Run:
    exact = case.chain
    names = ["mass", "stiffness", "drive_stiffness", "drive_velocity", "mu_s", "mu_k"]
    chain = Chain(weights=[float(w) for w in exact.weights], **{n: float(getattr(exact, n)) for n in names})
    start = case.start_positions and [float(x) for x in case.start_positions]
    return simulate(chain, float(Fraction(case.duration)), start_positions=start)


@pytest.mark.parametrize("name", sorted(read_held_out()))
def test_held_out_chains_have_no_error_predicted_too_small(name: str) -> None:
    case, golden = read_held_out()[name]
    run = held_out_run(case)
    predictions = predicted_errors(run)
    for k in np.flatnonzero(np.isfinite(predictions.time_error)).tolist():
        time, block, mode, _ = run.transitions[k].tolist()
        truth: Transition = golden[k]
        assert (block, mode) == (truth.block, truth.mode)
        # Closed forms are met to the last digit, which is counted with the time.
        assert abs(float(Fraction(time) - truth.time)) <= OPTIMISM * max(predictions.time_error[k], 1e-17)


def test_a_block_that_only_touches_standstill_ends_the_horizon() -> None:
    case, _ = read_held_out()["grazing"]
    run = held_out_run(case)
    predictions = predicted_errors(run)
    # At 28 N/(K V) the block is released; whether it stops one period later no rounded number can tell.
    assert predictions.order_known_until == run.transitions["time"][0]
    assert predictions.horizon(1.0) == predictions.order_known_until


@pytest.mark.parametrize(("miss", "is_lost"), [(1e-8, True), (1e-3, False)])
def test_a_standstill_missed_by_less_than_the_error_ends_the_horizon(
    miss: float, is_lost: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(module, "EPS", 1e-9)
    chain = Chain.from_slider(n_blocks=1, mu_k=0.70, drive_velocity=0.01)
    # About steady sliding the velocity swings from nearly 2 V down to `miss` V, half a period later.
    start = {"start_positions": [-280.0 / 0.8e6], "start_velocities": [0.01 * (2.0 - miss)]}
    run = simulate(chain, 5e-4, **start)
    assert len(run.transitions) == 1
    until = predicted_errors(run).order_known_until
    half_period = np.pi * np.sqrt(chain.mass / chain.drive_stiffness)
    assert until == (pytest.approx(half_period, rel=NEAR) if is_lost else np.inf)


def test_a_block_that_stops_at_the_limit_of_static_friction_ends_the_horizon() -> None:
    chain = Chain.from_slider(n_blocks=1, normal_load=40.0)
    slow, fast = 0.1, 10.0  # m/s: at rest after the slip, thrown back by the spring
    for _ in range(60):
        middle = (slow + fast) / 2
        sticks = thrown(chain, middle).transitions["mode"][1] == 0
        slow, fast = (middle, fast) if sticks else (slow, middle)
    for speed, is_lost in ((slow, True), (fast, True), (0.99 * slow, False), (1.01 * fast, False)):
        run = thrown(chain, speed)
        until = predicted_errors(run).order_known_until
        assert until == (pytest.approx(run.transitions["time"][1], rel=1e-12) if is_lost else np.inf)


def thrown(chain: Chain, speed: float) -> Run:
    """The first two transitions of a chain that moves from the start [m/s]."""
    return first_transitions(chain, 2, start_velocities=[speed])


def test_a_mirror_symmetric_start_ends_the_horizon_at_its_tie() -> None:
    start = [0, 0, 0, 1e-5, 0, 0, 0]
    run = simulate(Chain.from_slider(n_blocks=7), 0.3, start_positions=start)
    # Blocks 2 and 6 are released at the same instant, after the three that move from the start.
    assert set(run.transitions["block"][3:5]) == {2, 6}
    assert predicted_errors(run).horizon(1.0) <= run.transitions["time"][4]


def test_a_start_at_the_limit_of_static_friction_is_not_trusted() -> None:
    chain = Chain.from_slider(n_blocks=2, normal_load=100.0)
    pushed = float(chain.strength[1] / chain.stiffness)
    run = simulate(chain, 0.5, start_positions=[pushed, 0.0])
    predictions = predicted_errors(run)
    assert predictions.order_known_until == 0.0


def test_what_comes_later_does_not_change_the_horizon() -> None:
    chain = Chain.from_slider(theta="5/6", drive_velocity=0.01)
    whole = predicted_errors(simulate(chain, 0.16))
    for duration in (0.011, 0.05, 0.12):
        part = predicted_errors(simulate(chain, duration))
        assert np.array_equal(part.time_error, whole.time_error[: len(part.time_error)])
        for tolerance in TOLERANCES:
            expected = min(duration, whole.horizon(tolerance))
            assert part.horizon(tolerance) == pytest.approx(expected, rel=1e-6)


@pytest.mark.parametrize("seed", range(3))
def test_a_run_with_other_roundings_stays_within_the_predicted_errors(seed: int) -> None:
    """All forces times a factor give the same motion with another rounding at every step."""
    rng = np.random.default_rng(seed)
    for _ in range(30):
        chain, factor = random_chain(rng), rng.uniform(1.0, 8.0)
        scaled = ("weights", "mass", "stiffness", "drive_stiffness")
        other = replace(chain, **{name: factor * getattr(chain, name) for name in scaled})
        run, same = simulate(chain, 2.0), simulate(other, 2.0)
        predictions = predicted_errors(run)
        known = np.isfinite(predictions.time_error)
        found, expected = same.transitions[: len(known)][known], run.transitions[known]
        assert found[["block", "mode"]].tolist() == expected[["block", "mode"]].tolist()
        # Both runs are off by the error.
        assert (abs(found["time"] - expected["time"]) <= 2 * predictions.time_error[known]).all()


def test_the_horizon_ends_where_the_first_error_beyond_the_tolerance_may_begin() -> None:
    errors = PredictedErrors(np.array([1.0, 2.0, 2.1]), np.array([1e-12, 1e-3, 0.5]), 3.0, np.inf)
    ends = [errors.horizon(tolerance) for tolerance in (1e-13, 1e-9, 1e-3, 1e-2, 1.0)]
    assert ends == pytest.approx([1.0 - 1e-12, 2.0 - 1e-3, 2.0, 2.0, 3.0], rel=1e-15)


def test_equal_coefficients_of_friction_are_judged_at_once() -> None:
    """Blocks that are released come back to standstill and only touch it."""
    run = simulate(Chain.from_slider(mu_k=0.70), 1.0)
    assert len(run.transitions) > 10_000
    assert predicted_errors(run).order_known_until == run.transitions["time"][0]


@pytest.mark.parametrize("tolerance", [0.0, -1e-9, float("nan"), "1e-9"])
def test_a_tolerance_must_be_a_positive_number(tolerance: object) -> None:
    run = simulate(Chain.from_slider(), 0.4)
    with pytest.raises(ValueError, match="tolerance must be"):
        horizon(run, tolerance)  # type: ignore[arg-type]


@pytest.mark.parametrize("theta", LINEARISED)
def test_the_exponents_are_those_of_the_linearised_motion(theta: str) -> None:
    exponent = lyapunov_exponent(simulate(Chain.from_slider(theta=theta), 100.0))
    # Beyond the predictability time another rounding gives another run, and a mean over it another value.
    assert exponent.per_second == pytest.approx(LINEARISED[theta], abs=exponent.per_second_uncertainty)
    assert exponent.per_second_uncertainty < exponent.per_second
    growth = exponent.per_second * (exponent.end - exponent.start)
    assert exponent.per_transition * exponent.n_transitions == pytest.approx(growth)


def test_the_exponent_does_not_depend_on_the_distance(monkeypatch: pytest.MonkeyPatch) -> None:
    run = simulate(Chain.from_slider(theta="5/6"), 10.0)
    near = lyapunov_exponent(run).per_second
    monkeypatch.setattr(lyapunov, "DISTANCE", 100 * lyapunov.DISTANCE)
    assert lyapunov_exponent(run).per_second == pytest.approx(near, rel=1e-3)


def test_the_exponent_is_a_rate() -> None:
    chain = Chain.from_slider(theta="5/6", drive_velocity=1e-3)
    # Four times the mass, half the speed: the same motion, twice as slow, and in binary to the last digit.
    slow = Chain(
        chain.weights,
        4 * chain.mass,
        chain.stiffness,
        chain.drive_stiffness,
        chain.drive_velocity / 2,
        0.7,
        0.45,
    )
    one, other = lyapunov_exponent(simulate(chain, 2.0)), lyapunov_exponent(simulate(slow, 4.0))
    assert other.per_second == pytest.approx(one.per_second / 2, rel=1e-12)
    assert other.per_transition == pytest.approx(one.per_transition, rel=1e-12)


def test_the_interval_of_an_exponent_holds_it_in_95_of_100_cases(monkeypatch: pytest.MonkeyPatch) -> None:
    """On made-up events: differences grow by a half on average, while a second and 21 transitions pass."""
    random, cases, n = np.random.default_rng(3), 1000, 400
    held = []
    for _ in range(cases):
        onset, growth = np.cumsum(1 + random.poisson(20, n)), np.cumsum(random.normal(0.5, 1.0, n))
        time = np.zeros(onset[-1] + 1)
        time[onset] = np.cumsum(random.exponential(size=n))
        monkeypatch.setattr(lyapunov, "_growth", lambda _, found=(onset, growth): found)
        found = lyapunov_exponent(SimpleNamespace(transitions={"time": time}))  # type: ignore[arg-type]
        held.append(abs(found.per_second - 0.5) <= found.per_second_uncertainty)
        held.append(abs(found.per_transition - 0.5 / 21) <= found.per_transition_uncertainty)
    # Three standard errors of so many cases: both rates share their growth.
    assert np.mean(held) == pytest.approx(0.95, abs=3 * np.sqrt(0.95 * 0.05 / cases))


def test_an_exponent_is_certain_where_differences_grow_in_proportion_to_time(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    onset, time = np.arange(400), np.cumsum(np.random.default_rng(5).exponential(size=400))
    monkeypatch.setattr(lyapunov, "_growth", lambda _: (onset, 0.5 * time))
    found = lyapunov_exponent(SimpleNamespace(transitions={"time": time}))  # type: ignore[arg-type]
    assert found.per_second == pytest.approx(0.5)
    assert found.per_second_uncertainty == pytest.approx(0.0, abs=1e-12)
    assert found.per_transition_uncertainty > 0.01


def test_one_block_has_no_exponent() -> None:
    run = simulate(Chain.from_slider(n_blocks=1, drive_velocity=0.02), 5.0)
    with pytest.raises(ValueError, match="all differences die out"):
        lyapunov_exponent(run)


def test_a_run_needs_one_event_after_its_transient_for_each_stretch_and_one_to_begin_with(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    run = SimpleNamespace(transitions={"time": np.arange(100.0)})
    for n, used in ((20, None), (21, 20), (40, 20), (41, 40)):
        first = n * lyapunov.TRANSIENT / (1 - lyapunov.TRANSIENT)  # number of events in the transient
        found = np.arange(round(first) + n), np.arange(round(first) + n, dtype=float)
        monkeypatch.setattr(lyapunov, "_growth", lambda _, found=found: found)
        if used:
            assert lyapunov_exponent(run).n_events == used  # type: ignore[arg-type]
        else:
            with pytest.raises(ValueError, match="more than 20 slip events after its transient, but has 20"):
                lyapunov_exponent(run)  # type: ignore[arg-type]


def test_what_moves_at_the_start_has_no_error():
    run = simulate(Chain.from_slider(), 0.01, start_velocities=np.full(10, 1e-3))
    error = predicted_errors(run).time_error
    assert (error[:10] == 0.0).all()
    assert (error[10:] > 0.0).all()


def test_neighbours_differ_by_64_roundings_in_every_number():
    """And the error of the first release, at mu_s w_1 / (K V), follows from how far theirs are apart."""
    chain = Chain.from_slider()
    run = simulate(chain, 1.0, start_positions=np.full(10, 1e-6), start_velocities=np.full(10, 1e-3))
    others = neighbours(run)
    assert len(others) == 16
    start = ("start_positions", "start_velocities")
    mine, *theirs = (
        np.hstack([*list(vars(one.chain).values())[:7], *(getattr(one, name) for name in start)])
        for one in (run, *others)
    )
    roundings = (np.array(theirs) / mine - 1.0) / (np.finfo(float).eps / 2)
    np.testing.assert_allclose(roundings.std(axis=0), 64.0, rtol=0.6)
    assert np.sqrt(np.mean(roundings**2)) == pytest.approx(64.0, rel=0.05)
    assert np.corrcoef(roundings.T)[~np.eye(mine.size, dtype=bool)].max() < 0.9
    first = predicted_errors(simulate(chain, 1.0))
    release = [one.chain.strength[0] / one.chain.loading_rate for one in (run, *others)]
    apart = np.sqrt(np.mean((np.array(release[1:]) - release[0]) ** 2))
    rounding = np.finfo(float).eps * release[0]
    assert first.time_error[0] == pytest.approx(6.0 / 64.0 * apart + rounding, rel=0.1, abs=0.0)
