"""Regularised friction: blocks creep under less than mu_s w, and the narrower the law,
the stiffer it is.

A steep tanh stands in place of the jump at zero velocity, with a Stribeck drop to mu_k:

    mu(v) = tanh(v / width) (mu_k + (mu_s - mu_k) exp(-(v / (STRIBECK width))^2)).

Nothing ever sticks: a block under a constant load F < mu_s w creeps at
`creep_velocity`, and the equations are as stiff as mu_s w / (m width).
"""

from __future__ import annotations

import math
from functools import partial

import numpy as np
from scipy.integrate import solve_ivp

from maegawa2010.methods.columns import at_rest, set_modes, time_unit
from maegawa2010.methods.events import jacobian_of
from maegawa2010.methods.stability import bisect, highest_frequency
from maegawa2010.studies.failures.common import Curve, Failure, Threshold
from precursors.model.chain import Chain, FloatArray

# The drop begins where tanh has all but reached 1, so that friction at its largest is
# mu_s to 1e-3.
STRIBECK = 100.0
WIDTHS = (1e-5, 1e-6, 1e-7)  # m/s
LOADS = np.array([0.3, 0.6, 0.9])  # parts of mu_s w
STIFF_WIDTHS = np.geomspace(1e-9, 1e-4, 11)  # m/s
LIMIT_WIDTH = 1e-6  # of the threshold
# A stiff decay is stable with RK4 up to this lambda dt.
RK4_REAL_LIMIT = 2.785293563
STEPS = 200
BISECTIONS = 8


def friction_coefficient(
    velocity: FloatArray, width: float, mu_s: float, mu_k: float
) -> FloatArray:
    """mu(v) of velocities [m/s] for a width [m/s]."""
    z = velocity / width
    return np.tanh(z) * (mu_k + (mu_s - mu_k) * np.exp(-((z / STRIBECK) ** 2)))


def creep_velocity(ratio: float, width: float) -> float:
    """Velocity [m/s] at which a block held by friction creeps under the load ratio *
    mu_s w.

    The Stribeck drop is left out: at the load r mu_s w it changes the velocity by a
    part of about (1 - mu_k / mu_s) (atanh(r) / STRIBECK)^2 r / ((1 - r^2) atanh(r)).
    """
    return width * math.atanh(ratio)


def measured_creep(ratio: float, width: float) -> float:
    """Velocity [m/s] of a block under the load ratio * mu_s w, which friction should
    hold."""
    block = Chain.from_slider(n_blocks=1)
    load = ratio * block.mu_s

    def rate(_time: float, velocity: FloatArray) -> FloatArray:
        friction = friction_coefficient(velocity, width, block.mu_s, block.mu_k)
        return block.normal_load * (load - friction) / block.mass

    solution = solve_ivp(rate, (0.0, 1.0), [0.0], "Radau", rtol=1e-8, atol=1e-18)
    return float(solution.y[0, -1])


def creep() -> Failure:
    """Regularised friction: a block under less than mu_s w creeps."""
    drive = Chain.from_slider().drive_velocity
    fine = np.linspace(0.02, 0.99, 98)
    curves = [Curve("the drive", fine[[0, -1]], [drive, drive], "reference")]
    for width in WIDTHS:
        setting = f"width = {width:.0e} m/s"
        theory = [creep_velocity(ratio, width) for ratio in fine]
        measured = [measured_creep(ratio, width) for ratio in LOADS]
        curves += [
            Curve(setting, fine, theory, "theory"),
            Curve(setting, LOADS, measured),
        ]
    return Failure("load_over_strength", "velocity_m_per_s", curves)


def matrix_at_rest(chain: Chain, width: float) -> FloatArray:
    """Matrix of the equations with regularised friction, linear about rest [1/tau],
    where d mu/dv = mu_s / width."""
    system, state = at_rest(chain, scaled=True)
    set_modes(system, state, 1.0)
    matrix = jacobian_of(system, state)
    i = np.arange(chain.n_blocks, 2 * chain.n_blocks)
    matrix[i, i] -= time_unit(chain) * chain.strength / (chain.mass * width)
    return matrix


def fastest_rate(chain: Chain, width: float) -> float:
    """Largest eigenvalue of that matrix [1/s]."""
    rates = abs(np.linalg.eigvals(matrix_at_rest(chain, width)))
    return float(rates.max()) / time_unit(chain)


def creep_grows(chain: Chain, width: float, step: float) -> bool:
    """Whether RK4 with a step [s] raises velocities far below the width, which friction
    should brake."""
    z = step / time_unit(chain) * matrix_at_rest(chain, width)
    one = np.eye(len(z))
    of_step = one + z @ (one + z @ (one + z @ (one + z / 4.0) / 3.0) / 2.0)
    velocities = np.linalg.matrix_power(of_step, STEPS).sum(axis=1)[chain.n_blocks :]
    return bool((abs(velocities) > 1.0).any())


def stiffness() -> Failure:
    """Regularised friction: the narrower, the stiffer."""
    chain = Chain.from_slider()
    omega = highest_frequency(chain)
    rates = [fastest_rate(chain, width) for width in STIFF_WIDTHS]
    at_unit_width = float(chain.strength.max()) / chain.mass
    grows = partial(creep_grows, chain, LIMIT_WIDTH)
    expected = RK4_REAL_LIMIT / fastest_rate(chain, LIMIT_WIDTH)
    limit = Threshold(
        method="rk4_regularised",
        n_blocks=chain.n_blocks,
        fails="creep_grows",
        theory="2.785 m width / (mu_s w)",
        predicted=RK4_REAL_LIMIT * LIMIT_WIDTH / at_unit_width,
        measured=bisect(grows, 0.5 * expected, 2.0 * expected, BISECTIONS),
    )
    curves = [
        Curve("theory", STIFF_WIDTHS, at_unit_width / STIFF_WIDTHS, "theory"),
        Curve("measured", STIFF_WIDTHS, rates),
        Curve("the chain itself", STIFF_WIDTHS[[0, -1]], [omega, omega], "reference"),
    ]
    return Failure("width_m_per_s", "fastest_rate_per_s", curves, limit)
