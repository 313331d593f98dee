"""Symplectic methods with a fixed step: velocity Verlet (leapfrog) and semi-implicit Euler.

Stick and slip are switched once a step, as with `rk4`; while all blocks stick the wait is in closed form.
"""

from __future__ import annotations

import math

from precursors.methods.columns import accelerate, inner, outer, stretch
from precursors.methods.common import Smooth
from precursors.methods.fixed_step import fixed_step, run_in_steps, slide_in_steps

LIMIT = 2.0  # largest stable omega dt, of both methods


def energy_factor(z: float) -> float:
    """Factor on the energy in a step in the long run, z = omega dt: 1 up to the limit, for both methods."""
    return math.exp(2.0 * math.acosh(max(0.5 * z * z - 1.0, 1.0)))


@inner
def verlet_step(system, state, last, h, _work):
    """Half a step of the forces, a step of the motion, half a step of the forces (L. Verlet, 1967)."""
    accelerate(state, last, 0.5 * h)
    stretch(system, state, last, h)
    accelerate(state, last, 0.5 * h)
    return 1


@inner
def euler_step(system, state, last, h, _work):
    """A step of the forces, then one of the motion with the new velocities."""
    accelerate(state, last, h)
    stretch(system, state, last, h)
    return 1


@outer
def slide_verlet(system, state, h, n_steps):
    """Make n steps of all blocks as they slide, without switching."""
    slide_in_steps(system, state, h, n_steps, verlet_step, 0)


@outer
def slide_euler(system, state, h, n_steps):
    """The same."""
    slide_in_steps(system, state, h, n_steps, euler_step, 0)


@outer
def run_verlet(motion, step):
    """Run with a step [s], see `run_in_steps`.

    The forces at the end of a step are those at the start of the next: one evaluation a step, and one more
    where friction has changed in between.
    """
    return run_in_steps(motion, step, True, verlet_step, 1, 0)


@outer
def run_euler(motion, step):
    """The same with one evaluation a step."""
    return run_in_steps(motion, step, True, euler_step, 0, 0)


METHODS = tuple(
    fixed_step(
        name,
        label,
        run,
        values=(6e-6, 3e-6, 1e-6, 3e-7, 1e-7, 3e-8, 1e-8, 3e-9, 1e-9),
        whole=(1e-6, 1e-7, 3e-8, 1e-8, 3e-9),
        quick=(1e-6, 1e-7, 1e-8, 3e-9),
        quick_whole=(1e-7,),
        smooth=Smooth(slide, order, LIMIT, energy_factor),
    )
    for name, label, run, slide, order in (
        ("leapfrog", "leapfrog", run_verlet, slide_verlet, 2),
        ("semi_implicit_euler", "semi-implicit Euler", run_euler, slide_euler, 1),
    )
)
