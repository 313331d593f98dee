"""Energy that is made or lost: steps beyond the stability limit, and implicit
damping."""

from __future__ import annotations

from functools import partial

import numpy as np

from precursors.accuracy.compare import transitions_right
from precursors.accuracy.failures.common import Curve, Failure, Number
from precursors.analysis.slips import first_global_slip, slip_table
from precursors.methods import METHODS, ROWS, DivergedError
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
    lines = []
    numbers = []
    for name, n_steps in UNSTABLE_STEPS.items():
        method = METHODS[name]
        smooth = method.smooth
        label = ROWS[name]["label"].removesuffix(", every step")
        assert smooth
        z = smooth.limit * np.linspace(0.9, 1.1, POINTS)
        fine = smooth.limit * np.linspace(0.9, 1.1, 201)
        left = [
            energy_left(chain, smooth.slide, x / omega, n_steps, mode) ** (1 / n_steps)
            for x in z
        ]
        theory = [smooth.energy_factor(x) for x in fine]
        lines.append(Curve(label, fine / omega, theory, "theory"))
        lines.append(Curve(label, z / omega, left))
        numbers.append(
            Number(
                method=label,
                setting=f"omega dt = {z[-1]:.3g}",
                quantity="energy_per_step",
                unit="1",
                measured=left[-1],
                exact=1.0,
                predicted=smooth.energy_factor(z[-1]),
            )
        )
    return Failure(tuple(numbers), "step_s", "energy_per_step", tuple(lines))


def silent_instability() -> Failure:
    """RK4 above its limit with friction: stops take the energy away, so that no number
    overflows at first."""
    chain = Chain.from_slider()
    omega = highest_frequency(chain)
    exact = simulate(chain, END, "global slip")
    true = first_global_slip(slip_table(exact))
    assert true
    finished = []
    mu_sapp = []
    right = 0
    for z in BEYOND:
        try:
            run = METHODS["rk4_skip"].solve(chain, END, z / omega, "global slip").run
        except DivergedError:
            break
        if (friction := first_global_slip(slip_table(run))) is None:
            break
        finished.append(z)
        mu_sapp.append(friction.mu_sapp)
        right = max(right, transitions_right(run, exact))
    number = partial(Number, "RK4", "theta = 0")
    n = len(exact.transitions)
    return Failure(
        (
            number("least_mu_sapp", "1", min(mu_sapp), true.mu_sapp),
            number("largest_mu_sapp", "1", max(mu_sapp), true.mu_sapp),
            number("most_transitions_right", "1", right, n),
        ),
        x="step_s",
        y="mu_sapp",
        curves=(
            Curve("exact", BEYOND[[0, -1]] / omega, [true.mu_sapp] * 2, "exact"),
            Curve("RK4", np.array(finished) / omega, mu_sapp),
        ),
    )


def numerical_damping() -> Failure:
    """Implicit Moreau-Jean time stepping slows down what moves freely."""
    chain = without_friction(Chain.from_slider())
    omega = highest_frequency(chain)
    mode = highest_mode(chain)
    times = np.linspace(0.0, SLIP, POINTS)
    lines = []
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
        numbers.append(
            Number(
                method=ROWS[name]["label"],
                setting=setting,
                quantity="energy_left",
                unit="1",
                measured=left[-1],
                exact=1.0,
                predicted=factor ** (SLIP / step),
            )
        )
        if name == "moreau_jean_one":
            lines.append(Curve(setting, times, factor ** (times / step), "theory"))
            lines.append(Curve(setting, times, left))
    return Failure(tuple(numbers), "time_s", "energy_left", tuple(lines))
