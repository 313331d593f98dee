"""Regularised friction: blocks creep under a load below mu_s w.

A steep tanh replaces the jump at zero velocity, with a Stribeck drop to mu_k:

    mu(v) = tanh(v / width) (mu_k + (mu_s - mu_k) exp(-(v / (STRIBECK width))^2)).

A block never sticks: under a constant load F < mu_s w it creeps at `creep_velocity`.
"""

import math

import numpy as np
from scipy.integrate import solve_ivp

from maegawa2010.studies.failures.common import Curve
from precursors.model.chain import Chain, FloatArray

# The drop begins where tanh is nearly 1, so that the largest friction coefficient is
# mu_s to 1e-3.
STRIBECK = 100.0
WIDTHS = (1e-5, 1e-6, 1e-7)  # m/s
LOADS = np.array([0.3, 0.6, 0.9])  # over mu_s w


def friction_coefficient(
    velocity: FloatArray, width: float, mu_s: float, mu_k: float
) -> FloatArray:
    """mu(v) for velocities [m/s] and a width [m/s]."""
    z = velocity / width
    return np.tanh(z) * (mu_k + (mu_s - mu_k) * np.exp(-((z / STRIBECK) ** 2)))


def creep_velocity(ratio: float, width: float) -> float:
    """Velocity [m/s] at which a block creeps under the load ratio * mu_s w, by theory.

    The Stribeck drop is neglected: at the load r mu_s w its relative effect is about
    (1 - mu_k / mu_s) (atanh(r) / STRIBECK)^2 r / ((1 - r^2) atanh(r)).
    """
    return width * math.atanh(ratio)


def measured_creep(ratio: float, width: float) -> float:
    """Computed velocity [m/s] of a block under the load ratio * mu_s w, at which it
    should stick."""
    block = Chain.from_slider(n_blocks=1)
    load = ratio * block.mu_s

    def rate(_time: float, velocity: FloatArray) -> FloatArray:
        friction = friction_coefficient(velocity, width, block.mu_s, block.mu_k)
        return block.normal_load * (load - friction) / block.mass

    solution = solve_ivp(rate, (0.0, 1.0), [0.0], "Radau", rtol=1e-8, atol=1e-18)
    return float(solution.y[0, -1])


def creep() -> list[Curve]:
    """With regularised friction a block creeps under a load below mu_s w."""
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
    return curves
