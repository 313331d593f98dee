"""Moreau-Jean time stepping: implicit springs, and friction as a set-valued law of the
velocity at the end of a step.

M. Jean, Comput. Methods Appl. Mech. Engrg. 177 (1999) 235-257; V. Acary and B.
Brogliato, Numerical Methods for Nonsmooth Dynamical Systems (2008). A prime marks the end
of a step; theta and the spring forces T* belong to a time within it:

    m (v' - v) = h (T*_i - T*_{i+1} - R_i),
    T* = T + theta h c_i (u_{i-1} - u_i),  u = theta v' + (1 - theta) v,

The friction R_i of a block is mode_i mu_k w_i if v' has the sign of its mode, and any
value up to mu_s w_i if v' = 0. Because mu_s > mu_k both can be solutions; then a block
that stuck in the last step sticks, and one that slid slides. An active-set iteration
determines the modes: it solves the tridiagonal system for the sliding blocks, stops those
that would move against their mode, and releases those whose R exceeds mu_s w, until no
mode changes.
"""

import math
from functools import partial

import numpy as np

from maegawa2010.methods.columns import (
    FORCE,
    FRICTION,
    INVERSE_MASS,
    MOBILITY,
    MODE,
    SPRING,
    STRENGTH,
    VELOCITY,
)
from maegawa2010.methods.compiled import inner, outer
from maegawa2010.methods.equations import move_by, net_force, solve_springs
from maegawa2010.methods.fixed_step import (
    STEPS_IN_LEG,
    begin_leg,
    change_mode,
    feels,
    step_length,
)
from maegawa2010.methods.march import fixed_step

# The active set usually settles after two or three solutions. Where it would cycle, the
# iteration stops after this many.
SOLUTIONS_PER_BLOCK = 4


def energy_factor(z: float, theta: float) -> float:
    """Factor on the energy of a mode in a step, z = omega dt: 1 at theta = 1/2, less above."""
    return (1.0 + ((1.0 - theta) * z) ** 2) / (1.0 + (theta * z) ** 2)


@inner
def explicit_forces(system, state, last, h, theta, known):
    """The part of the spring forces T* that does not depend on the new velocities."""
    force = state[FORCE]
    velocity = state[VELOCITY]
    spring = system[SPRING]
    part = theta * (1.0 - theta) * h
    for i in range(1, last + 2):
        known[i] = force[i] + part * spring[i] * (velocity[i - 1] - velocity[i])
    for i in range(last + 2, force.shape[0]):
        known[i] = force[i]


@inner
def solve_velocities(system, state, last, h, theta, work):
    """Compute the new velocities of blocks 1..last; stuck blocks have zero."""
    known, factor, new = work
    for i in range(1, last + 1):
        slides = h * state[MOBILITY, i]
        net = known[i] - known[i + 1] - state[FRICTION, i]
        new[i] = state[VELOCITY, i] + slides * net if slides > 0.0 else 0.0
    solve_springs(system, state, last, (theta * h) ** 2, new, factor)


@inner
def finish(system, state, last, h, theta, new):
    """Finish a step: set the new velocities and update the spring forces."""
    force = state[FORCE]
    velocity = state[VELOCITY]
    spring = system[SPRING]
    for i in range(1, last + 2):
        before = velocity[i - 1] - velocity[i]
        after = new[i - 1] - new[i]
        force[i] += h * spring[i] * (theta * after + (1.0 - theta) * before)
        velocity[i - 1] = new[i - 1]


@inner
def static_friction(system, state, i, h, theta, work):
    """Friction R_i that gives block i the velocity v' = 0 [N]."""
    known, _, new = work
    spring = system[SPRING]
    reach = theta * theta * h
    behind = known[i] + reach * spring[i] * (new[i - 1] - new[i])
    ahead = known[i + 1] + reach * spring[i + 1] * (new[i] - new[i + 1])
    return behind - ahead + state[VELOCITY, i] / (system[INVERSE_MASS, i] * h)


@inner
def step_modes(system, state, last, h, theta, work, trial):
    """Determine the modes and new velocities of a step; return the farthest sliding block
    and the number of solutions."""
    known, _, new = work
    explicit_forces(system, state, last, h, theta, known)
    most = SOLUTIONS_PER_BLOCK * (state.shape[1] - 1)
    for solutions in range(1, most + 1):
        solve_velocities(system, state, last, h, theta, work)
        changed = False
        for i in range(1, feels(state, last) + 1):
            mode = trial[i]
            if mode != 0.0:
                if new[i] * mode < 0.0:
                    mode = 0.0
            else:
                friction = static_friction(system, state, i, h, theta, work)
                if abs(friction) > system[STRENGTH, i]:
                    mode = np.sign(friction)
            if mode != trial[i]:
                trial[i] = mode
                move_by(system, state, i, mode)
                last = max(last, i)
                changed = True
        if not changed:
            return last, solutions
    return last, most


@outer
def run_moreau_jean(motion, step, theta):
    """Run with a step [s].

    A block that turns round first stops in a step; if its springs overcome static
    friction at the end of that step, it then slides the other way. Each solution of the
    tridiagonal system counts as an evaluation.
    """
    system = motion.system
    state = motion.state
    progress = motion.progress[0]
    trial = state[MODE].copy()
    velocities = state[VELOCITY].copy()
    work = np.zeros_like(trial), np.zeros_like(trial), velocities
    while begin_leg(motion):
        trial[1] = state[MODE, 1]
        last = progress.last
        for _ in range(STEPS_IN_LEG):
            h = step_length(progress, step)
            last, solutions = step_modes(system, state, last, h, theta, work, trial)
            finish(system, state, last, h, theta, velocities)
            progress.evaluations += solutions
            progress.elapsed += h
            if h < step or solutions > 1:
                break
        for i in range(1, last + 1):
            old = int(state[MODE, i])
            new = int(trial[i])
            if old != 0 and new == 0:
                state[VELOCITY, i] = 0.0
                net = net_force(state, i)
                if old * net < -system[STRENGTH, i]:
                    new = -old
                    trial[i] = new
            if new != old:
                change_mode(motion, i, new)


# Between transitions theta = 1/2 is of order 2 and does not damp; theta = 1 is of order 1
# and damps motion that is faster than a step.
METHODS = tuple(
    fixed_step(
        name,
        partial(run_moreau_jean, theta=theta),
        smooth=(math.inf, partial(energy_factor, theta=theta)),
    )
    for name, theta in (("moreau_jean_half", 0.5), ("moreau_jean_one", 1.0))
)
