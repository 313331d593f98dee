"""Newmark's method of constant average acceleration.

N. M. Newmark, J. Eng. Mech. Div. ASCE 85 (1959) 67-94, with beta = 1/4 and gamma = 1/2.
It is implicit, stable at any step, of order 2 and keeps the energy of a mode:

    m a' = T'_i - T'_{i+1} - mode_i mu_k w_i,
    u' - u = h v + h^2 (a + a') / 4,  v' = v + h (a + a') / 2.

Stick and slip are switched once a step, as with `rk4`.
"""

from __future__ import annotations

import math

import numpy as np

from precursors.methods.columns import FORCE, FRICTION, MOBILITY, SPRING, VELOCITY
from precursors.methods.compiled import inner, outer
from precursors.methods.equations import solve_springs
from precursors.methods.fixed_step import run_in_steps
from precursors.methods.march import fixed_step

ACCELERATION, NEW, FACTOR, MOVED = range(4)  # rows to work in


def energy_factor(_z: float) -> float:
    """Factor on the energy in a step in the long run."""
    return 1.0


@inner
def newmark_step(system, state, last, h, work):
    """One step h [s] of blocks 1..last; one of no length finds the accelerations."""
    acceleration = work[ACCELERATION]
    new = work[NEW]
    factor = work[FACTOR]
    moved = work[MOVED]
    force = state[FORCE]
    velocity = state[VELOCITY]
    spring = system[SPRING]
    quarter = 0.25 * h * h
    moved[0] = h * velocity[0]
    moved[last + 1] = 0.0
    for i in range(1, last + 1):
        moved[i] = h * velocity[i] + quarter * acceleration[i]
    for i in range(1, last + 1):
        behind = force[i] + spring[i] * (moved[i - 1] - moved[i])
        ahead = force[i + 1] + spring[i + 1] * (moved[i] - moved[i + 1])
        new[i] = state[MOBILITY, i] * (behind - ahead - state[FRICTION, i])
    solve_springs(system, state, last, quarter, new, factor)
    for i in range(1, last + 1):
        moved[i] += quarter * new[i]
        force[i] += spring[i] * (moved[i - 1] - moved[i])
        velocity[i] += 0.5 * h * (acceleration[i] + new[i])
        acceleration[i] = new[i]
    force[last + 1] += spring[last + 1] * moved[last]
    return 1


@outer
def run_newmark(motion, step):
    """Run with a step [s], see `run_in_steps`."""
    run_in_steps(motion, step, newmark_step, True, np.zeros(motion.state.shape))


METHODS = (fixed_step("newmark", run_newmark, smooth=(2, math.inf, energy_factor)),)
