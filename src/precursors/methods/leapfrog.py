"""Symplectic methods with a fixed step: velocity Verlet (leapfrog) and semi-implicit Euler.

Stick and slip are switched once a step, as with `rk4`; while all blocks stick the wait is in closed form.
"""

from __future__ import annotations

from precursors.methods.common import fixed_step
from precursors.methods.forces import (
    ELAPSED,
    EVALUATIONS,
    LAST,
    LEGS_PER_CALL,
    MOVING,
    PAUSED,
    STEPS_IN_LEG,
    accelerate,
    all_keep_their_modes,
    begin_leg,
    inner,
    outer,
    step_length,
    stretch,
    switch,
)

STEPS = (6e-6, 3e-6, 1e-6, 3e-7, 1e-7, 3e-8, 1e-8, 3e-9, 1e-9)


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
    """Make n steps of all blocks as they slide, without switching: the smooth method alone."""
    last = state.mode.shape[0] - 2
    for _ in range(n_steps):
        if verlet:
            verlet_step(system, state, last, h)
        else:
            euler_step(system, state, last, h)


@outer
def run_symplectic(system, state, record, clock, count, duration, until_global, step, verlet):
    """Run until `duration` [s], the end of the first global slip, a full record or a spent budget.

    The forces at the end of a Verlet step are those at the start of the next: one evaluation a step, and one
    more where friction has changed in between.
    """
    for _ in range(LEGS_PER_CALL):
        status = begin_leg(system, state, record, clock, count, duration, until_global, True)
        if status != MOVING:
            return status
        if verlet:
            count[EVALUATIONS] += 1
        for _ in range(STEPS_IN_LEG):
            h = step_length(clock, duration, step)
            if verlet:
                verlet_step(system, state, count[LAST], h)
            else:
                euler_step(system, state, count[LAST], h)
            count[EVALUATIONS] += 1
            clock[ELAPSED] += h
            if h < step or not all_keep_their_modes(system, state, count[LAST]):
                break
        switch(system, state, record, clock, count)
    return PAUSED


METHODS = (
    # Of order 2 and 1 while nothing switches.
    fixed_step("leapfrog", "leapfrog", STEPS, run_symplectic, True),
    fixed_step("semi_implicit_euler", "semi-implicit Euler", STEPS, run_symplectic, False),
)
