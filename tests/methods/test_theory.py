"""While nothing switches, limits and energy of fixed-step methods are those of
theory."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from maegawa2010.methods import SMOOTH
from maegawa2010.methods.tableaus import DOP853, RK4
from maegawa2010.studies.failures.stability import (
    energy_left,
    highest_frequency,
    highest_mode,
    without_friction,
)
from precursors import Chain

UNSTABLE = [name for name, smooth in SMOOTH.items() if 0.0 < smooth.limit < np.inf]
LIMIT_TOLERANCE = 1e-6
# Of a factor per step: rounding of some tens of steps, and of the frequency.
FACTOR_TOLERANCE = 1e-9
INTERPOLATION = 1e-12


@pytest.fixture(scope="module")
def free() -> Chain:
    return without_friction(Chain.from_slider())


@pytest.mark.parametrize("name", UNSTABLE)
def test_energy_grows_beyond_the_limit_and_not_below_it(name):
    smooth = SMOOTH[name]
    below, beyond = smooth.limit * np.array([1 - LIMIT_TOLERANCE, 1 + LIMIT_TOLERANCE])
    assert smooth.energy_factor(below) <= 1.0 < smooth.energy_factor(beyond)


@pytest.mark.parametrize(
    ("name", "z", "n_steps"),
    [
        ("rk4", 3.0, 20),
        ("leapfrog", 2.2, 20),
        ("moreau_jean_half", 3.0, 200),
        ("moreau_jean_one", 0.1, 200),
    ],
)
def test_a_step_changes_the_energy_of_the_fastest_mode_by_the_closed_form(
    free, name, z, n_steps
):
    step = z / highest_frequency(free)
    mode = highest_mode(free)
    smooth = SMOOTH[name]
    # Once the energy swings no more: leapfrog's second root fades meanwhile.
    once, twice = (
        energy_left(free, smooth.slide, step, n, mode) for n in (n_steps, 2 * n_steps)
    )
    assert (twice / once) ** (1 / n_steps) == pytest.approx(
        smooth.energy_factor(z), rel=FACTOR_TOLERANCE
    )


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"stages": 1.01 * RK4.stages}, r"h\^2 in a step must be 1/2!"),
        ({"stages": RK4.stages.T}, "needs a rate after it"),
    ],
)
def test_coefficients_that_are_not_those_of_their_order_are_refused(change, message):
    with pytest.raises(ValueError, match=message):
        replace(RK4, **change)


@pytest.mark.parametrize("tableau", [RK4, DOP853])
def test_the_interpolation_of_a_step_has_the_values_and_rates_of_both_ends(tableau):
    s = len(tableau.weights)
    powers = tableau.powers
    n = np.arange(1, len(powers) + 1)
    np.testing.assert_allclose(powers.sum(0), tableau.shares[s], atol=INTERPOLATION)
    rate_at_start = np.eye(len(tableau.shares))[0]
    rate_at_end = np.eye(len(tableau.shares))[s]
    np.testing.assert_allclose(powers[0], rate_at_start, atol=INTERPOLATION)
    np.testing.assert_allclose(n @ powers, rate_at_end, atol=INTERPOLATION)
