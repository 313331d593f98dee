"""Between transitions, fixed-step methods have the stability limits and the energy of
theory."""

import numpy as np
import pytest

from maegawa2010.methods import SMOOTH
from maegawa2010.methods.stability import (
    energy_left,
    highest_frequency,
    highest_mode,
    without_friction,
)
from precursors import Chain

UNSTABLE = [name for name, smooth in SMOOTH.items() if 0.0 < smooth.limit < np.inf]
LIMIT_TOLERANCE = 1e-6
# Of a factor per step: rounding in the steps and in the frequency.
FACTOR_TOLERANCE = 1e-9


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
def test_a_step_changes_energy_by_the_factor_of_theory(free, name, z, n_steps):
    step = z / highest_frequency(free)
    mode = highest_mode(free)
    smooth = SMOOTH[name]
    # The ratio leaves out the first steps, in which leapfrog's decaying solution fades.
    once, twice = (
        energy_left(free, smooth.slide, step, n, mode) for n in (n_steps, 2 * n_steps)
    )
    assert (twice / once) ** (1 / n_steps) == pytest.approx(
        smooth.energy_factor(z), rel=FACTOR_TOLERANCE
    )
