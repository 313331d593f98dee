"""Energy that is made or lost: steps beyond the stability limit, and implicit
damping."""

from __future__ import annotations

from functools import partial

import numpy as np
from numpy.typing import ArrayLike

from precursors.accuracy.compare import transitions_right
from precursors.accuracy.failures.common import Failure, Number, curves
from precursors.analysis.slips import apparent_friction, slip_table
from precursors.methods import METHODS, DivergedError
from precursors.methods.rk4 import LIMIT as RK4_LIMIT
from precursors.methods.stability import (
    energy_left,
    highest_frequency,
    highest_mode,
    without_friction,
)
from precursors.model.chain import Chain
from precursors.solver.simulate import simulate

# Steps over which the factor per step is an average: more for leapfrog, whose energy
# also swings, fewer for RK4, which damps the mode below the rounding of the others.
UNSTABLE_STEPS = {"rk4": 20, "leapfrog": 200}
POINTS = 21
# With friction: omega dt from RK4's limit on, and where its runs end.
BEYOND = RK4_LIMIT * np.linspace(1.0, 1.25, 51)[1:]
END = 10.0  # s
# Time of a short slip [s], and the steps with which Moreau-Jean time stepping goes
# through it.
SLIP = 100e-6
DAMPING_STEPS = (1e-6, 1e-7, 1e-8)


def unstable() -> Failure:
    """RK4 above omega dt = 2 sqrt 2 and leapfrog above 2, without friction."""
    chain = without_friction(Chain.from_slider())
    omega = highest_frequency(chain)
    mode = highest_mode(chain)
    lines: dict[str, tuple[ArrayLike, ArrayLike]] = {}
    numbers = []
    for name, n_steps in UNSTABLE_STEPS.items():
        method = METHODS[name]
        smooth = method.smooth
        label = method.label.removesuffix(", every step")
        assert smooth
        z = smooth.limit * np.linspace(0.9, 1.1, POINTS)
        fine = smooth.limit * np.linspace(0.9, 1.1, 201)
        left = [
            energy_left(chain, smooth.slide, x / omega, n_steps, mode) ** (1 / n_steps)
            for x in z
        ]
        lines[f"theory, {label}"] = (
            fine / omega,
            [smooth.energy_factor(x) for x in fine],
        )
        lines[label] = (z / omega, left)
        factor = smooth.energy_factor(z[-1])
        numbers.append(
            Number(
                label,
                f"omega dt = {z[-1]:.3g}",
                "energy a step",
                "1",
                left[-1],
                1.0,
                factor,
            )
        )
    return Failure(tuple(numbers), curves("step_s", "energy_per_step", **lines))


def silent_instability() -> Failure:
    """RK4 above its limit with friction: stops take the energy away, so that no number
    overflows at first."""
    chain = Chain.from_slider()
    omega = highest_frequency(chain)
    exact = simulate(chain, END, "global slip")
    true = apparent_friction(slip_table(exact))
    assert true
    finished = []
    mu_sapp = []
    right = 0
    for z in BEYOND:
        try:
            run = METHODS["rk4_skip"].solve(chain, END, z / omega, "global slip").run
        except DivergedError:
            break
        if (friction := apparent_friction(slip_table(run))) is None:
            break
        finished.append(z)
        mu_sapp.append(friction.mu_sapp)
        right = max(right, transitions_right(run, exact))
    number = partial(Number, "RK4", "theta = 0")
    numbers = (
        number("least mu_sapp of these", "1", min(mu_sapp), true.mu_sapp),
        number("largest mu_sapp of these", "1", max(mu_sapp), true.mu_sapp),
        number("most transitions right of these", "1", right, len(exact.transitions)),
    )
    line = BEYOND[[0, -1]] / omega, (true.mu_sapp, true.mu_sapp)
    found = np.array(finished) / omega, mu_sapp
    return Failure(numbers, curves("step_s", "mu_sapp", exact=line, RK4=found))


def numerical_damping() -> Failure:
    """Implicit Moreau-Jean time stepping slows down what moves freely."""
    chain = without_friction(Chain.from_slider())
    omega = highest_frequency(chain)
    mode = highest_mode(chain)
    times = np.linspace(0.0, SLIP, POINTS)
    lines: dict[str, tuple[ArrayLike, ArrayLike]] = {}
    numbers = []
    runs = [
        *(("moreau_jean_one", step) for step in DAMPING_STEPS),
        ("moreau_jean_half", DAMPING_STEPS[0]),
    ]
    for name, step in runs:
        method = METHODS[name]
        assert method.smooth
        n_steps = np.linspace(0, round(SLIP / step), POINTS).astype(int)
        left = [
            energy_left(chain, method.smooth.slide, step, int(n), mode) for n in n_steps
        ]
        setting = f"dt = {step:.0e} s"
        factor = method.smooth.energy_factor(omega * step)
        number = partial(Number, method.label, setting, "energy left after 100 us", "1")
        numbers.append(number(left[-1], 1.0, factor ** (SLIP / step)))
        if name == "moreau_jean_one":
            lines[f"theory, {setting}"] = (times, factor ** (times / step))
            lines[setting] = (times, left)
    return Failure(tuple(numbers), curves("time_s", "energy_left", **lines))
