"""Regularised friction: blocks creep under less than mu_s w, and the narrower the law,
the stiffer it is.

A steep tanh stands in place of the jump at zero velocity, with a Stribeck drop to mu_k:

    mu(v) = tanh(v / width) (mu_k + (mu_s - mu_k) exp(-(v / (STRIBECK width))^2)).

Nothing ever sticks: a block under a constant load F < mu_s w creeps at
`creep_velocity`, and the equations are as stiff as mu_s w / (m width).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp

from precursors.accuracy.failures.common import (
    Curve,
    Failure,
    Number,
    Threshold,
    runge_kutta_step,
)
from precursors.methods.columns import SPRING, VELOCITY, at_rest, set_modes, time_unit
from precursors.methods.events import jacobian_of
from precursors.methods.stability import bisect, highest_frequency
from precursors.model.chain import Chain, FloatArray

# The drop begins where tanh has all but reached 1, so that friction at its largest is
# mu_s to 1e-3.
STRIBECK = 100.0
WIDTHS = (1e-5, 1e-6, 1e-7)  # m/s
LOADS = np.array([0.3, 0.6, 0.9])  # parts of mu_s w
STIFF_WIDTHS = np.geomspace(1e-9, 1e-4, 11)  # m/s
CHARTED_WIDTH = 1e-6
CHARTED_LOAD = 0.9
# A stiff decay is stable with RK4 up to this lambda dt.
RK4_REAL_LIMIT = 2.785293563
METHOD = "RK4, friction regularised to 1e-06 m/s"
CREEP_GROWS = "creep_grows"  # it becomes a growing oscillation
STEPS = 200
BISECTIONS = 8


def friction_coefficient(
    velocity: FloatArray, width: float, mu_s: float, mu_k: float
) -> FloatArray:
    """mu(v) of velocities [m/s] for a width [m/s]."""
    z = velocity / width
    return np.tanh(z) * (mu_k + (mu_s - mu_k) * np.exp(-((z / STRIBECK) ** 2)))


def friction_slope(velocity: Any, width: float, mu_s: float, mu_k: float) -> Any:
    """d mu / dv [s/m]."""
    z = velocity / width
    tanh = np.tanh(z)
    drop = (mu_s - mu_k) * np.exp(-((z / STRIBECK) ** 2))
    return (
        (1.0 - tanh**2) * (mu_k + drop) - tanh * drop * 2.0 * z / STRIBECK**2
    ) / width


def creep_velocity(load: float, weight: float, width: float, mu_s: float) -> float:
    """Velocity [m/s] at which a block held by friction creeps under a load F [N]: width
    atanh(F / mu_s w).

    The Stribeck drop is left out: at the load r mu_s w it changes the velocity by a
    part of about (1 - mu_k / mu_s) (atanh(r) / STRIBECK)^2 r / ((1 - r^2) atanh(r)).
    """
    return width * math.atanh(load / (mu_s * weight))


def equations(
    chain: Chain, width: float
) -> tuple[
    Callable[[float, FloatArray], FloatArray], Callable[[float, FloatArray], FloatArray]
]:
    """Right-hand side and Jacobian for the state y of `events`, friction being a
    function of velocity."""
    n = chain.n_blocks
    law = (width * chain.mass / time_unit(chain), chain.mu_s, chain.mu_k)
    system, state = at_rest(chain, scaled=True)
    set_modes(system, state, 1.0)
    linear = jacobian_of(system, state)
    drive = np.zeros(2 * n)
    drive[0] = system[SPRING, 1] * state[VELOCITY, 0]
    i = np.arange(n, 2 * n)

    def right_hand_side(_time: float, state: FloatArray) -> FloatArray:
        result = linear @ state + drive
        result[n:] -= chain.weights * friction_coefficient(state[n:], *law)
        return result

    def matrix(_time: float, state: FloatArray) -> FloatArray:
        result = linear.copy()
        result[i, i] = -chain.weights * friction_slope(state[n:], *law)
        return result

    return right_hand_side, matrix


def measured_creep(ratio: float, width: float) -> float:
    """Velocity [m/s] of a block under the load ratio * mu_s w, which friction should
    hold."""
    # So soft a drive keeps the load constant.
    chain = Chain.from_slider(n_blocks=1, drive_stiffness=1e-3, drive_velocity=1e-12)
    start = [ratio * float(chain.strength[0]), 0.0]
    right_hand_side, jacobian = equations(chain, width)
    solution = solve_ivp(
        right_hand_side,
        (0.0, 1.0),
        start,
        "Radau",
        jac=jacobian,
        rtol=1e-8,
        atol=[1e-8, 1e-18],
    )
    return float(solution.y[1, -1]) * time_unit(chain) / chain.mass


def creep() -> Failure:
    """Regularised friction: a block under less than mu_s w creeps."""
    block = Chain.from_slider(n_blocks=1)
    weight = float(block.weights[0])
    strength = float(block.strength[0])
    fine = np.linspace(0.02, 0.99, 98)
    drive = block.drive_velocity
    lines = [Curve("the drive", fine[[0, -1]], [drive, drive], "reference")]
    for width in WIDTHS:
        setting = f"width = {width:.0e} m/s"
        creeping = [
            creep_velocity(ratio * strength, weight, width, block.mu_s)
            for ratio in fine
        ]
        lines.append(Curve(setting, fine, creeping, "theory"))
        lines.append(
            Curve(setting, LOADS, [measured_creep(ratio, width) for ratio in LOADS])
        )
    speed = measured_creep(CHARTED_LOAD, CHARTED_WIDTH)
    theory = creep_velocity(CHARTED_LOAD * strength, weight, CHARTED_WIDTH, block.mu_s)
    setting = f"width = {CHARTED_WIDTH:.0e} m/s, F = {CHARTED_LOAD:g} mu_s w"
    number = partial(Number, "regularised friction", setting)
    return Failure(
        (
            number("creep_velocity", "m/s", speed, 0.0, theory),
            number("creep_over_drive", "1", speed / drive, 0.0, theory / drive),
        ),
        x="load_over_strength",
        y="velocity_m_per_s",
        curves=tuple(lines),
    )


def matrix_at_rest(chain: Chain, width: float) -> FloatArray:
    """Matrix of the equations with regularised friction, linear about rest [1/tau]."""
    _, jacobian = equations(chain, width)
    return jacobian(0.0, np.zeros(2 * chain.n_blocks))


def fastest_rate(chain: Chain, width: float) -> float:
    """Largest eigenvalue of that matrix [1/s]."""
    return float(
        np.abs(np.linalg.eigvals(matrix_at_rest(chain, width))).max()
    ) / time_unit(chain)


def creep_grows(chain: Chain, width: float, step: float) -> bool:
    """Whether RK4 with a step [s] raises velocities far below the width, which friction
    should brake."""
    matrix = matrix_at_rest(chain, width)
    n = chain.n_blocks
    start = state = np.ones(2 * n)
    for _ in range(STEPS):
        state = runge_kutta_step(matrix.__matmul__, state, step / time_unit(chain))
    return bool((abs(state) > start)[n:].any())


def longest_step(chain: Chain, width: float) -> float:
    """Step [s] from which RK4 makes creep grow; by bisection."""
    expected = RK4_REAL_LIMIT / fastest_rate(chain, width)
    return bisect(
        partial(creep_grows, chain, width), 0.5 * expected, 2.0 * expected, BISECTIONS
    )


def stiffness() -> Failure:
    """Regularised friction: the narrower, the stiffer."""
    chain = Chain.from_slider()
    omega = highest_frequency(chain)
    rates = [fastest_rate(chain, width) for width in STIFF_WIDTHS]
    at_unit_width = float(chain.strength.max()) / chain.mass
    theory = at_unit_width / STIFF_WIDTHS
    limit = Threshold(
        method="rk4_regularised",
        label=METHOD,
        n_blocks=chain.n_blocks,
        fails=CREEP_GROWS,
        unit="s",
        theory="2.785 m width / (mu_s w)",
        predicted=RK4_REAL_LIMIT * CHARTED_WIDTH / at_unit_width,
        measured=longest_step(chain, CHARTED_WIDTH),
    )
    number = Number(
        method="regularised friction",
        setting=f"width = {CHARTED_WIDTH:.0e} m/s",
        quantity="fastest_rate",
        unit="1/s",
        measured=fastest_rate(chain, CHARTED_WIDTH),
        exact=omega,
        predicted=at_unit_width / CHARTED_WIDTH,
    )
    return Failure(
        (number,),
        x="width_m_per_s",
        y="fastest_rate_per_s",
        curves=(
            Curve("theory", STIFF_WIDTHS, theory, "theory"),
            Curve("measured", STIFF_WIDTHS, rates),
            Curve(
                "the chain itself", STIFF_WIDTHS[[0, -1]], [omega, omega], "reference"
            ),
        ),
        thresholds=(limit,),
    )
