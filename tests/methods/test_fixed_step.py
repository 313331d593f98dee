"""Runs of fixed-step methods: orders of accuracy, limits, and located roots."""

import numpy as np
import pytest

from maegawa2010.methods import METHODS, DivergedError, runge_kutta
from maegawa2010.methods.fixed_step import FIRST_ROOM
from maegawa2010.methods.march import march
from maegawa2010.methods.runge_kutta import run_rk4
from maegawa2010.methods.stability import highest_frequency
from precursors import Chain, Run, TransitionLimitError, simulate
from precursors.analysis.agreement import transitions_right

# Orders with transitions, and the two steps between which they are measured [s].
ORDERS = {
    # A transition within a step is an error of its length.
    **dict.fromkeys(
        ("rk4", "leapfrog", "moreau_jean_half", "moreau_jean_one"),
        (1.0, 5e-8, 5e-9),
    ),
    "rk4_located": (4.0, 8e-7, 2e-7),
}
# The position of a transition within its step is random: averaged over this many steps, an
# error of a few per cent remains.
STEPS_IN_SAMPLE = 60
ORDER_TOLERANCE = 0.15
CLOCK_ROUNDING = 1e-9  # relative, of a sum of about 1e6 steps
ROUNDING = 1e-12  # of a cubic with coefficients of order one
FIVE_SLIPS = 1.25  # s; the first of theta = 0, with 30 transitions


@pytest.fixture(scope="module")
def chain() -> Chain:
    return Chain.from_slider()


@pytest.fixture(scope="module")
def five_slips(chain: Chain) -> Run:
    return simulate(chain, FIVE_SLIPS)


def load_error(run: Run, exact: Run) -> float:
    """Root mean square error of F_X at the transitions [N]; the transitions must be the
    right ones."""
    assert (
        transitions_right(run, exact) == len(run.transitions) == len(exact.transitions)
    )
    difference = (
        run.transitions["tangential_load"] - exact.transitions["tangential_load"]
    )
    return float(np.sqrt(np.mean(difference**2)))


def test_a_diverging_run_ends_with_its_last_finite_transition(chain):
    step = 1.5 * 2.0 / highest_frequency(chain)
    with pytest.raises(DivergedError, match="the numbers overflow at") as diverged:
        METHODS["leapfrog"].solve(chain, 10.0, step, None)
    run = diverged.value.run
    assert np.isfinite(run.transitions["tangential_load"]).all()
    assert run.duration < 10.0
    ends = np.append(run.transitions["time"], run.duration)
    np.testing.assert_allclose(np.cumsum(run.intervals), ends, rtol=CLOCK_ROUNDING)


def test_a_full_record_grows_and_a_run_ends_at_the_limit():
    chain = Chain.from_slider(n_blocks=3, drive_velocity=1e-2)
    with pytest.raises(
        TransitionLimitError, match=f"max_transitions = {2 * FIRST_ROOM} reached"
    ) as limit:
        march(run_rk4, chain, 10.0, 1e-6, max_transitions=2 * FIRST_ROOM)
    run = limit.value.run
    assert transitions_right(run, simulate(chain, 0.05)) > 40
    assert (np.diff(run.transitions["time"]) >= 0.0).all()
    assert run.intervals.sum() == pytest.approx(run.duration)


@pytest.mark.parametrize("name", ORDERS)
def test_the_order_depends_on_how_transitions_are_located(five_slips, name):
    order, coarse, fine = ORDERS[name]

    def error(step: float) -> float:
        steps = step * np.linspace(0.8, 1.2, STEPS_IN_SAMPLE)
        runs = (
            METHODS[name].solve(five_slips.chain, FIVE_SLIPS, h, None).run
            for h in steps
        )
        return float(
            np.sqrt(np.mean([load_error(run, five_slips) ** 2 for run in runs]))
        )

    measured = np.log(error(coarse) / error(fine)) / np.log(coarse / fine)
    assert measured == pytest.approx(order, abs=ORDER_TOLERANCE)


def test_a_step_ends_at_the_first_of_two_close_roots():
    """The function is positive at both ends, as when a velocity falls below zero and
    rises again within a step. A function without a root has none."""
    random = np.random.default_rng(1)
    for _ in range(1000):
        first = random.uniform(0.02, 0.9)
        apart = 10.0 ** random.uniform(-7.0, -0.5)
        polynomial = np.polynomial.Polynomial.fromroots([first, first + apart])
        polynomial *= np.polynomial.Polynomial([1.0, random.uniform(-0.9, 0.9)])
        c = polynomial.coef
        root = runge_kutta.cubic_root(c, 1.0)
        assert root == pytest.approx(first, abs=ROUNDING / apart)
        above = np.append(c[0] + apart**2, c[1:])
        assert runge_kutta.cubic_root(above, 1.0) == runge_kutta.NEVER


def test_a_root_at_the_start_counts_only_if_the_function_falls():
    rises_and_falls = np.array([0.0, 0.4, -1.0, 0.0])
    assert runge_kutta.cubic_root(rises_and_falls, 1.0) == pytest.approx(0.4)
    assert runge_kutta.cubic_root(rises_and_falls, 0.3) == runge_kutta.NEVER
    assert runge_kutta.cubic_root(-rises_and_falls, 1.0) == 0.0
