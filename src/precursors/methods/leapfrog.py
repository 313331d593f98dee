"""Fixed steps of one evaluation: velocity Verlet (leapfrog), semi-implicit Euler and
forward Euler.

Stick and slip are switched once a step, as with `rk4`; while all blocks stick the wait
is in closed form. The first two are symplectic: they keep a mode's energy up to their
limit. Forward Euler has no limit, as it makes energy at any step.
"""

from __future__ import annotations

import math

import numpy as np

from precursors.methods.compiled import inner, outer
from precursors.methods.equations import accelerate, by_mode, rates, stretch
from precursors.methods.fixed_step import run_in_steps
from precursors.methods.march import fixed_step

LIMIT = 2.0  # largest stable omega dt, of both symplectic methods
# Share of a step of the forces that is made before the step of the motion.
VERLET = 0.5
SEMI_IMPLICIT = 1.0


def energy_factor(z: float) -> float:
    """Factor on the energy in a step in the long run, z = omega dt: 1 up to the limit,
    for both methods."""
    return math.exp(2.0 * math.acosh(max(0.5 * z * z - 1.0, 1.0)))


def euler_energy_factor(z: float) -> float:
    """Factor of forward Euler on the energy in a step, z = omega dt: |1 + iz|^2."""
    return 1.0 + z * z


@inner
def symplectic_step(system, state, last, h, before):
    """A part of a step of the forces, a step of the motion, the rest of the forces (L.
    Verlet, 1967)."""
    accelerate(state, last, before * h)
    stretch(system, state, last, h)
    if before < 1.0:
        accelerate(state, last, (1.0 - before) * h)
    return 1


@inner
def euler_step(system, state, last, h, rate):
    """A step of the forces and of the motion, both from where the step begins."""
    rates(by_mode, 0.0, system, state, last, state, rate)
    for i in range(1, last + 2):
        for row in range(2):
            state[row, i] += h * rate[row, i]
    return 1


@outer
def run_symplectic(motion, step, before):
    """Run with a step [s], see `run_in_steps`.

    The forces at the end of a step of Verlet are those at the start of the next: one
    evaluation a step, and one more where friction has changed in between.
    """
    run_in_steps(motion, step, symplectic_step, before < 1.0, before)


@outer
def run_euler(motion, step):
    """The same with one evaluation a step."""
    run_in_steps(motion, step, euler_step, False, np.zeros(motion.state.shape))


METHODS = (
    fixed_step("leapfrog", run_symplectic, VERLET, smooth=(2, LIMIT, energy_factor)),
    fixed_step(
        "semi_implicit_euler",
        run_symplectic,
        SEMI_IMPLICIT,
        smooth=(1, LIMIT, energy_factor),
    ),
    fixed_step("forward_euler", run_euler, smooth=(1, 0.0, euler_energy_factor)),
)
