"""Newmark's method of constant average acceleration, and the HHT method, which damps
fast modes.

N. M. Newmark, J. Eng. Mech. Div. ASCE 85 (1959) 67-94; H. M. Hilber, T. J. R. Hughes
and R. L. Taylor, Earthquake Eng. Struct. Dyn. 5 (1977) 283-292. Both are implicit,
stable at any step and of order 2:

    m a' = (1 + alpha) (T'_i - T'_{i+1}) - alpha (T_i - T_{i+1}) - mode_i mu_k w_i, u' -
    u = h v + h^2 ((1/2 - beta) a + beta a'),  v' = v + h ((1 - gamma) a + gamma a'),

with beta = (1 - alpha)^2 / 4 and gamma = 1/2 - alpha; alpha = 0 is Newmark's method
with beta = 1/4 and gamma = 1/2. Stick and slip are switched once a step, as with `rk4`.
"""

from __future__ import annotations

import math
from functools import partial
from typing import Any

import numpy as np

from precursors.methods.columns import FORCE, FRICTION, MOBILITY, SPRING, VELOCITY
from precursors.methods.common import Method
from precursors.methods.compiled import inner, outer
from precursors.methods.equations import solve_springs
from precursors.methods.fixed_step import fixed_step, run_in_steps

NEWMARK = 0.0
HHT = -0.1
ACCELERATION, NEW, FACTOR, MOVED = range(4)  # rows to work in
CHARTED = (1e-5, 3e-6, 1e-6, 3e-7, 1e-7, 3e-8, 1e-8, 3e-9)


def energy_factor(z: float, alpha: float) -> float:
    """Factor on the energy in a step in the long run, z = omega dt: its largest
    eigenvalue, squared."""
    beta = 0.25 * (1.0 - alpha) ** 2
    gamma = 0.5 - alpha
    new = np.array([1.0, 1.0 + alpha, (1.0 + alpha) * (0.5 - beta)])
    new *= -(z**2) / (1.0 + (1.0 + alpha) * beta * z**2)
    step = [
        [1.0, 1.0, 0.5 - beta] + beta * new,
        [0.0, 1.0, 1.0 - gamma] + gamma * new,
        new,
    ]
    return float(abs(np.linalg.eigvals(step)).max() ** 2)


@inner
def newmark_step(system, state, last, h, settings):
    """One step h [s] of blocks 1..last; a step of no length finds the accelerations to
    begin with."""
    alpha, work = settings
    acceleration = work[ACCELERATION]
    new = work[NEW]
    factor = work[FACTOR]
    moved = work[MOVED]
    force = state[FORCE]
    velocity = state[VELOCITY]
    spring = system[SPRING]
    beta = 0.25 * (1.0 - alpha) ** 2
    gamma = 0.5 - alpha
    moved[0] = h * velocity[0]
    moved[last + 1] = 0.0
    for i in range(1, last + 1):
        moved[i] = h * velocity[i] + h * h * (0.5 - beta) * acceleration[i]
    for i in range(1, last + 1):
        behind = force[i] + (1.0 + alpha) * spring[i] * (moved[i - 1] - moved[i])
        ahead = force[i + 1] + (1.0 + alpha) * spring[i + 1] * (moved[i] - moved[i + 1])
        new[i] = state[MOBILITY, i] * (behind - ahead - state[FRICTION, i])
    solve_springs(system, state, last, (1.0 + alpha) * beta * h * h, new, factor)
    for i in range(1, last + 1):
        moved[i] += beta * h * h * new[i]
        force[i] += spring[i] * (moved[i - 1] - moved[i])
        velocity[i] += h * ((1.0 - gamma) * acceleration[i] + gamma * new[i])
        acceleration[i] = new[i]
    force[last + 1] += spring[last + 1] * moved[last]
    return 1


@outer
def run_newmark(motion, step, alpha):
    """Run with a step [s], see `run_in_steps`."""
    run_in_steps(
        motion, step, newmark_step, True, (alpha, np.zeros(motion.state.shape))
    )


def _method(name: str, label: str, alpha: float, **others: Any) -> Method:
    others |= {"smooth": (2, math.inf, partial(energy_factor, alpha=alpha))}
    return fixed_step(
        name, label, run_newmark, alpha, values=CHARTED, whole=CHARTED[2:7:2], **others
    )


METHODS = (
    _method(
        "newmark",
        "Newmark",
        NEWMARK,
        quick=(1e-6, 1e-7, 1e-8),
        look=("#6B8E23", "4,1,45"),
    ),
    _method("hht", "HHT", HHT, quick=(1e-7,), look=("#A9C25D", "10,1,0")),
)
