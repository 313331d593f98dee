"""Energy that is made or lost: steps beyond the stability limit, and implicit damping."""

from __future__ import annotations

from functools import partial

import numpy as np
from numpy.typing import ArrayLike

from precursors.accuracy.failures.common import Failure, Number, curves
from precursors.methods import METHODS
from precursors.methods.common import Method
from precursors.methods.stability import (
    energy_left,
    highest_frequency,
    highest_mode,
    largest_stable_step,
    without_friction,
)
from precursors.model.chain import Chain

# Steps over which the factor per step is an average: more for leapfrog, whose energy also swings, fewer for
# RK4, which damps the mode below the rounding of the others.
RK4_STEPS, LEAPFROG_STEPS = 20, 200
POINTS = 21
# Time of a short slip [s], and the steps with which Moreau-Jean time stepping goes through it.
SLIP = 100e-6
DAMPING_STEPS = (1e-6, 1e-7, 1e-8)


def rk4_unstable() -> Failure:
    """RK4 above omega dt = 2 sqrt 2."""
    return _unstable("RK4", METHODS["rk4"], RK4_STEPS)


def leapfrog_unstable() -> Failure:
    """Leapfrog above omega dt = 2."""
    return _unstable("leapfrog", METHODS["leapfrog"], LEAPFROG_STEPS)


def _unstable(label: str, method: Method, n_steps: int) -> Failure:
    chain = without_friction(Chain.from_slider())
    omega, mode = highest_frequency(chain), highest_mode(chain)
    smooth = method.smooth
    assert smooth
    found = largest_stable_step(chain, smooth.slide)
    z = smooth.limit * np.linspace(0.9, 1.1, POINTS)
    left = [energy_left(chain, smooth.slide, x / omega, n_steps, mode) ** (1 / n_steps) for x in z]
    fine = smooth.limit * np.linspace(0.9, 1.1, 201)
    bisection = partial(Number, label, "bisection")
    return Failure(
        (
            bisection("largest stable omega dt", "1", found * omega, smooth.limit),
            bisection("largest stable dt", "s", found, smooth.limit / omega),
            Number(label, f"omega dt = {z[-1]:.3g}", "energy a step", "1", left[-1], 1.0),
        ),
        curves(
            "omega_dt",
            "energy_per_step",
            theory=(fine, [smooth.energy_factor(x) for x in fine]),
            measured=(z, left),
        ),
    )


def numerical_damping() -> Failure:
    """Implicit Moreau-Jean time stepping slows down what moves freely."""
    chain = without_friction(Chain.from_slider())
    omega, mode = highest_frequency(chain), highest_mode(chain)
    times = np.linspace(0.0, SLIP, POINTS)
    lines: dict[str, tuple[ArrayLike, ArrayLike]] = {}
    numbers = []
    runs = [*(("moreau_jean_one", step) for step in DAMPING_STEPS), ("moreau_jean_half", DAMPING_STEPS[0])]
    for name, step in runs:
        method = METHODS[name]
        assert method.smooth
        n_steps = np.linspace(0, round(SLIP / step), POINTS).astype(int)
        left = [energy_left(chain, method.smooth.slide, step, int(n), mode) for n in n_steps]
        setting = f"dt = {step:.0e} s"
        numbers.append(Number(method.label, setting, "energy left after 100 us", "1", left[-1], 1.0))
        if name == "moreau_jean_one":
            factor = method.smooth.energy_factor(omega * step)
            lines[f"theory, {setting}"] = (times, factor ** (times / step))
            lines[setting] = (times, left)
    return Failure(tuple(numbers), curves("time_s", "energy_left", **lines))
