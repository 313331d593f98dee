"""Symplectic methods with a fixed step: velocity Verlet (leapfrog) and semi-implicit Euler.

Stick and slip are switched once a step, as with `rk4`; while all blocks stick the wait is in closed form.
"""

from __future__ import annotations

import math
from functools import partial

from precursors.methods.columns import accelerate, inner, outer, stretch
from precursors.methods.common import Smooth
from precursors.methods.fixed_step import (
    LEGS_PER_CALL,
    MOVING,
    PAUSED,
    STEPS_IN_LEG,
    all_keep_their_modes,
    begin_leg,
    fixed_step,
    step_length,
    switch,
)

LIMIT = 2.0  # largest stable omega dt, of both methods


def energy_factor(z: float) -> float:
    """Factor on the energy in a step in the long run, z = omega dt: 1 up to the limit, for both methods."""
    return math.exp(2.0 * math.acosh(max(0.5 * z * z - 1.0, 1.0)))


@inner
def verlet_step(system, state, last, h):
    """Half a step of the forces, a step of the motion, half a step of the forces (L. Verlet, 1967)."""
    accelerate(state, last, 0.5 * h)
    stretch(system, state, last, h)
    accelerate(state, last, 0.5 * h)


@inner
def euler_step(system, state, last, h):
    """A step of the forces, then one of the motion with the new velocities."""
    accelerate(state, last, h)
    stretch(system, state, last, h)


@outer
def slide(system, state, h, n_steps, verlet):
    """Make n steps of all blocks as they slide, without switching."""
    last = state.mode.shape[0] - 2
    for _ in range(n_steps):
        if verlet:
            verlet_step(system, state, last, h)
        else:
            euler_step(system, state, last, h)


@outer
def run_symplectic(motion, step, verlet):
    """Run until the end, a full record or a spent budget of legs.

    The forces at the end of a Verlet step are those at the start of the next: one evaluation a step, and one
    more where friction has changed in between.
    """
    system, state, progress = motion.system, motion.state, motion.progress
    for _ in range(LEGS_PER_CALL):
        status = begin_leg(motion, True)
        if status != MOVING:
            return status
        if verlet:
            progress.evaluations += 1
        for _ in range(STEPS_IN_LEG):
            h = step_length(progress, step)
            if verlet:
                verlet_step(system, state, progress.last, h)
            else:
                euler_step(system, state, progress.last, h)
            progress.evaluations += 1
            progress.elapsed += h
            if h < step or not all_keep_their_modes(system, state, progress.last):
                break
        switch(motion)
    return PAUSED


METHODS = tuple(
    fixed_step(
        name,
        label,
        run_symplectic,
        verlet,
        values=(6e-6, 3e-6, 1e-6, 3e-7, 1e-7, 3e-8, 1e-8, 3e-9, 1e-9),
        whole=(1e-6, 1e-7, 3e-8, 1e-8, 3e-9),
        quick=(1e-6, 1e-7, 1e-8, 3e-9),
        quick_whole=(1e-7,),
        smooth=Smooth(partial(slide, verlet=verlet), order, LIMIT, energy_factor),
    )
    for name, label, verlet, order in (
        ("leapfrog", "leapfrog", True, 2),
        ("semi_implicit_euler", "semi-implicit Euler", False, 1),
    )
)
