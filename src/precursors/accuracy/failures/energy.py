"""Energy that grows or is lost: steps beyond the stability limit, and implicit damping."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from precursors.accuracy.failures.common import Failure, Number, curves
from precursors.methods.moreau_jean import IMPLICIT
from precursors.methods.stability import (
    LEAPFROG_LIMIT,
    RK4_LIMIT,
    SLIDES,
    Slide,
    energy_left,
    highest_frequency,
    highest_mode,
    largest_stable_step,
    leapfrog_growth,
    moreau_jean_growth,
    rk4_growth,
    without_friction,
)
from precursors.model.chain import Chain, FloatArray

# Steps over which the growth a step is an average: more for leapfrog, whose energy also swings, fewer for
# RK4, which damps the mode below the rounding of the others.
RK4_STEPS, LEAPFROG_STEPS = 20, 200
POINTS = 21
# Time of a short slip [s], and the steps with which Moreau-Jean time stepping goes through it.
SLIP = 100e-6
DAMPING_STEPS = (1e-6, 1e-7, 1e-8)


def rk4_unstable() -> Failure:
    """RK4 above omega dt = 2 sqrt 2."""
    return _unstable("RK4", SLIDES["rk4"], RK4_LIMIT, rk4_growth, RK4_STEPS)


def leapfrog_unstable() -> Failure:
    """Leapfrog above omega dt = 2."""
    return _unstable("leapfrog", SLIDES["leapfrog"], LEAPFROG_LIMIT, leapfrog_growth, LEAPFROG_STEPS)


def _unstable(
    method: str, slide: Slide, limit: float, growth: Callable[[float], float], n_steps: int
) -> Failure:
    chain = without_friction(Chain.from_slider())
    omega = highest_frequency(chain)
    found = largest_stable_step(chain, slide)
    z = limit * np.linspace(0.9, 1.1, POINTS)
    measured = [
        energy_left(chain, slide, x / omega, n_steps, highest_mode(chain)) ** (1 / n_steps) for x in z
    ]
    fine = limit * np.linspace(0.9, 1.1, 201)
    beyond = z[-1]
    return Failure(
        (
            Number(method, "bisection", "largest stable omega dt", "1", found * omega, limit),
            Number(method, "bisection", "largest stable dt", "s", found, limit / omega),
            Number(method, f"omega dt = {beyond:.3g}", "energy a step", "1", measured[-1], 1.0),
        ),
        curves(
            "omega_dt",
            "energy_per_step",
            theory=(fine, [growth(x) for x in fine]),
            measured=(z, measured),
        ),
    )


def numerical_damping() -> Failure:
    """Implicit Moreau-Jean time stepping slows down what moves freely."""
    chain = without_friction(Chain.from_slider())
    omega, mode = highest_frequency(chain), highest_mode(chain)
    lines: dict[str, tuple[FloatArray, list[float]]] = {}
    numbers = []

    def add(method: str, slide: Slide, step: float) -> list[float]:
        n_steps = np.linspace(0, round(SLIP / step), POINTS).astype(int)
        left = [energy_left(chain, slide, step, int(n), mode) for n in n_steps]
        numbers.append(Number(method, f"dt = {step:.0e} s", "energy left after 100 us", "1", left[-1], 1.0))
        return left

    for step in DAMPING_STEPS:
        times = np.linspace(0.0, SLIP, POINTS)
        factor = moreau_jean_growth(omega * step, IMPLICIT)
        lines[f"theory, dt = {step:.0e} s"] = (times, [math.pow(factor, t / step) for t in times])
        lines[f"dt = {step:.0e} s"] = (times, add("Moreau-Jean, implicit", SLIDES["moreau_jean_one"], step))
    add("Moreau-Jean, trapezoidal", SLIDES["moreau_jean_half"], DAMPING_STEPS[0])
    return Failure(tuple(numbers), curves("time_s", "energy_left", **lines))
