"""Every failure mode is measured: what a method gives is not right, and is what theory
predicts."""

from functools import cache

import numpy as np
import pytest
from golden import small_tables
from scipy.integrate import solve_ivp

from maegawa2010.methods.scipy_events import watched
from maegawa2010.methods.stability import highest_frequency
from maegawa2010.studies.failures.common import Threshold
from maegawa2010.studies.failures.missed_roots import motion_after
from maegawa2010.studies.failures.regularised_friction import RK4_REAL_LIMIT
from maegawa2010.studies.failures.stability import NO_GLOBAL_SLIP, STOPPING, thresholds
from maegawa2010.studies.failures.tables import FAILURE_MODES, Failure
from precursors import Chain, simulate

# Between a measured curve or number and the closed form, of its first order.
THEORY_TOLERANCE = 0.02
# Factors between a measured threshold and its theory, from the side of safety and
# beyond, by what fails. Without friction a bisection leaves 1e-3. With it, fast modes
# are tried by what a run happens to do, at steps 2 % apart. Where a stop falls within a
# step is chance. Late transitions change the loads of those after them.
FACTORS = {
    "energy_unbounded": (0.999, 1.001),
    "energy_changed": (0.99, 1.01),
    "no_global_slip": (0.8, 1.25),
    "sequence_wrong": (0.2, 4.0),
    "creep_grows": (0.99, 1.02),
    "roots_missed": (0.7, 1.5),
}
# The mean of the factors with friction over the numbers of blocks: chance is less of
# it, and the limits that might be taken for each other are 1.15 to 1.41 apart.
MEAN_FACTOR = (0.9, 1.1)
N_FIVE = 30  # transitions of the first five slips


@cache
def measured(name: str) -> Failure:
    return FAILURE_MODES[name]()


@cache
def limits() -> list[Threshold]:
    return [
        *thresholds(),
        *filter(None, (measured(mode).threshold for mode in FAILURE_MODES)),
    ]


def curves(mode: str, role: str) -> dict[str, np.ndarray]:
    """Points of the curves of a failure mode in a role, shape (2, n), by their names."""
    return {
        c.name: np.array([c.x, c.y]) for c in measured(mode).curves if c.role == role
    }


@pytest.mark.parametrize(
    "mode",
    ["unstable", "numerical_damping", "dead_zone_too_large", "creep", "stiffness"],
)
def test_a_method_fails_as_theory_predicts(mode):
    theory = curves(mode, "theory")
    for name, (x, y) in curves(mode, "failing").items():
        predicted = np.interp(x, *theory.get(name, theory.get("theory")))
        # Near its limit, the energy of leapfrog swings.
        far = slice(-3 if mode == "unstable" else None, None)
        np.testing.assert_allclose(y[far], predicted[far], rtol=THEORY_TOLERANCE)


def test_what_a_method_gives_is_not_what_is_right():
    for name, right in {"unstable": 1.0, "numerical_damping": 1.0}.items():
        for _, y in curves(name, "failing").values():
            assert abs(y[-1] - right) > THEORY_TOLERANCE
    limit = Chain.from_slider().strength[0]
    assert curves("literal_friction", "exact")["exact"][1].max() > 2.5 * limit
    for _, load in curves("literal_friction", "failing").values():
        assert load.max() == pytest.approx(limit)
    for _, right in curves("dead_zone_too_small", "failing").values():
        assert right.min() < 0.6 * N_FIVE
    assert curves("dead_zone_too_large", "failing")["measured"][1].min() > 0.0
    (exact,) = curves("missed_roots", "exact").values()
    (steps,) = curves("missed_roots", "failing").values()
    assert exact[1].min() < 0.0
    assert (steps[1, 1:] > 0.0).all()


def test_curves_and_thresholds_are_those_that_are_kept():
    small_tables.assert_kept("failure_curves", small_tables.failure_curves(measured))
    small_tables.assert_kept("limits", small_tables.limits(measured))


@pytest.mark.parametrize("fails", FACTORS)
def test_a_threshold_is_where_theory_says(fails):
    chosen = [t for t in limits() if t.fails == fails]
    assert chosen
    for t in chosen:
        low, high = FACTORS[fails]
        if np.isinf(t.predicted):
            assert np.isinf(t.measured), t
        else:
            assert low * t.predicted < t.measured < high * t.predicted, t


@pytest.mark.parametrize("name", STOPPING)
def test_the_limit_with_friction_is_that_of_its_formula_and_of_no_other(name):
    factors = [
        t.measured / t.predicted
        for t in limits()
        if (t.method, t.fails) == (name, NO_GLOBAL_SLIP)
    ]
    assert MEAN_FACTOR[0] < np.mean(factors) < MEAN_FACTOR[1]


def test_one_block_with_friction_fails_where_its_first_stop_says():
    """By hand: after a step from rest, x becomes (1 - z^2 / 2 + z^4 / 24) x with RK4,
    (1 - z^2 / 2) x with leapfrog. At 1 the block goes on forward; at -(mu_s + mu_k) /
    (mu_s - mu_k) the force at the stop is -mu_s w."""
    z = {
        t.method: t.predicted
        for t in limits()
        if t.n_blocks == 1 and t.fails == NO_GLOBAL_SLIP
    }
    omega = np.sqrt(0.8e6 / 0.012)
    rk4, leapfrog = (omega * z[name] for name in ("rk4_skip", "leapfrog"))
    assert 1 - rk4**2 / 2 + rk4**4 / 24 == pytest.approx(1.0)
    assert 1 - leapfrog**2 / 2 == pytest.approx(-(0.70 + 0.45) / (0.70 - 0.45))


def test_rk4_beyond_its_limit_finishes_with_friction_and_is_wrong_at_every_step():
    (step, friction), *_ = curves("silent_instability", "failing").values()
    exact = curves("silent_instability", "exact")["exact"][1, 0]
    assert min(friction) < 0.95 * exact
    assert max(friction) > 1.05 * exact
    assert (abs(friction - exact) > 1e-6).all()
    assert len(step) > 20
    limit = 2.0 * np.sqrt(2.0) / highest_frequency(Chain.from_slider())
    assert step[0] == pytest.approx(1.005 * limit)


def test_a_motion_taken_from_a_run_goes_on_as_the_run_does():
    run = simulate(Chain.from_slider(), 10.0, "global slip")
    for k in (1, 28, 109, 200):
        motion = motion_after(run, k)
        numbers, events = zip(*watched(motion), strict=True)
        span, tight = (0.0, motion.remaining), {"rtol": 1e-9, "atol": 1e-9}
        found = solve_ivp(
            motion.rates, span, motion.y, "DOP853", events=events, **tight
        )
        assert found.t[-1] * motion.tau == pytest.approx(run.intervals[k], rel=1e-6)
        fired = [
            number
            for number, times in zip(numbers, found.t_events, strict=True)
            if len(times)
        ]
        assert fired[0] // 2 + 1 == run.transitions["block"][k]


def test_rk4_on_regularised_friction_breaks_at_the_step_that_is_given():
    """A decay at the rate lambda becomes a rise: |1 + z + z^2/2 + z^3/6 + z^4/24| > 1,
    z = -lambda dt."""
    factor = np.polynomial.Polynomial([1, 1, 1 / 2, 1 / 6, 1 / 24])
    assert factor(-RK4_REAL_LIMIT) == pytest.approx(1.0, abs=1e-8)
    assert factor(-1.001 * RK4_REAL_LIMIT) > 1.0
