"""Failures in which energy grows or is lost: steps beyond the stability limit, and
implicit damping."""

import numpy as np

from maegawa2010.methods import METHODS, ROWS, SMOOTH, DivergedError
from maegawa2010.methods.stability import (
    energy_left,
    highest_frequency,
    highest_mode,
    without_friction,
)
from maegawa2010.studies.failures.common import Curve
from precursors.analysis.summary import apparent_friction
from precursors.model.chain import Chain
from precursors.solver.simulate import simulate

# Number of steps over which the energy factor is averaged: many for leapfrog, whose
# energy oscillates; few for RK4, which soon damps the mode below rounding.
UNSTABLE_STEPS = {"rk4": 20, "leapfrog": 200}
POINTS = 21
# With friction: values of omega dt beyond RK4's limit, and the end of its runs.
BEYOND = SMOOTH["rk4"].limit * np.linspace(1.0, 1.25, 51)[1:]
END = 10.0  # s
# Duration of a short slip [s], and steps of Moreau-Jean time stepping [s].
SLIP = 100e-6
DAMPING_STEPS = (1e-6, 1e-7, 1e-8)


def unstable() -> list[Curve]:
    """Without friction, energy grows in RK4 above omega dt = 2 sqrt 2, and in leapfrog above
    omega dt = 2."""
    chain = without_friction(Chain.from_slider())
    omega = highest_frequency(chain)
    mode = highest_mode(chain)
    curves = []
    for name, n_steps in UNSTABLE_STEPS.items():
        method = SMOOTH[name]
        z = method.limit * np.linspace(0.9, 1.1, POINTS)
        fine = method.limit * np.linspace(0.9, 1.1, 201)
        left = [
            energy_left(chain, method.slide, x / omega, n_steps, mode) ** (1 / n_steps)
            for x in z
        ]
        theory = [method.energy_factor(x) for x in fine]
        curves += [
            Curve(ROWS[name]["label"], fine / omega, theory, "theory"),
            Curve(ROWS[name]["label"], z / omega, left),
        ]
    return curves


def silent_instability() -> list[Curve]:
    """With friction, RK4 above its limit gives wrong results without an overflow, because
    stops remove the energy."""
    chain = Chain.from_slider()
    exact = apparent_friction(simulate(chain, END, "global slip"))
    steps = BEYOND / highest_frequency(chain)
    mu_sapp = []
    for step in steps:
        try:
            run = METHODS["rk4"].solve(chain, END, step, "global slip").run
        except DivergedError:
            break
        if np.isnan(friction := apparent_friction(run)):
            break
        mu_sapp.append(friction)
    return [
        Curve("exact", steps[[0, -1]], [exact, exact], "exact"),
        Curve("RK4", steps[: len(mu_sapp)], mu_sapp),
    ]


def numerical_damping() -> list[Curve]:
    """Implicit Moreau-Jean time stepping damps free motion."""
    chain = without_friction(Chain.from_slider())
    omega = highest_frequency(chain)
    mode = highest_mode(chain)
    method = SMOOTH["moreau_jean_one"]
    times = np.linspace(0.0, SLIP, POINTS)
    curves = []
    for step in DAMPING_STEPS:
        n_steps = np.linspace(0, round(SLIP / step), POINTS).astype(int)
        left = [energy_left(chain, method.slide, step, int(n), mode) for n in n_steps]
        theory = method.energy_factor(omega * step) ** (times / step)
        setting = f"dt = {step:.0e} s"
        curves += [Curve(setting, times, theory, "theory"), Curve(setting, times, left)]
    return curves
