"""Moreau-Jean time stepping: implicit springs, friction as a set-valued law of the
velocity at a step's end.

M. Jean, Comput. Methods Appl. Mech. Engrg. 177 (1999) 235-257; V. Acary and B.
Brogliato, Numerical Methods for Nonsmooth Dynamical Systems (2008). With the spring
forces at the part theta of the step,

    m (v' - v) = h (T*_i - T*_{i+1} - R_i),
    T* = T + theta h c_i (u_{i-1} - u_i),  u = theta v' + (1 - theta) v,

the friction R_i of a block is mode_i mu_k w_i where v' has the sign of its mode, and
anything up to mu_s w_i where v' = 0. As mu_s > mu_k both can be true: a block that
stuck at the last step sticks, one that slid slides. The modes are found by an active
set: solve the tridiagonal system for the blocks that slide, stop those that go against
their mode, release those whose R exceeds mu_s w, until nothing changes.
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

# The active set settles in two or three solutions; where it goes in a circle, this many
# are enough.
SOLUTIONS_PER_BLOCK = 4


def energy_factor(z: float, theta: float) -> float:
    """Factor on the energy in a step, z = omega dt: 1 at theta = 1/2, less above."""
    return (1.0 + ((1.0 - theta) * z) ** 2) / (1.0 + (theta * z) ** 2)


@inner
def explicit_forces(system, state, last, h, theta, known):
    """Spring forces T* without the share of the new velocities."""
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
    """New velocities of the blocks 1..last that slide."""
    known, factor, new = work
    for i in range(1, last + 1):
        slides = h * state[MOBILITY, i]
        net = known[i] - known[i + 1] - state[FRICTION, i]
        new[i] = state[VELOCITY, i] + slides * net if slides > 0.0 else 0.0
    solve_springs(system, state, last, (theta * h) ** 2, new, factor)


@inner
def finish(system, state, last, h, theta, new):
    """Take over the new velocities and stretch the springs."""
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
    """Friction R_i that keeps block i at v' = 0, or brings it there [N]."""
    known, _, new = work
    spring = system[SPRING]
    reach = theta * theta * h
    behind = known[i] + reach * spring[i] * (new[i - 1] - new[i])
    ahead = known[i + 1] + reach * spring[i + 1] * (new[i] - new[i + 1])
    return behind - ahead + state[VELOCITY, i] / (system[INVERSE_MASS, i] * h)


@inner
def step_modes(system, state, last, h, theta, work, trial):
    """Find modes and new velocities of a step; return the farthest sliding block and
    the solutions made."""
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
    """Run in steps.

    A block that turns round needs a step to stop in, whose friction brakes it: where
    its springs overcome the static friction at the end of that step, it turns. Each
    solution of the tridiagonal system counts as an evaluation.
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


# theta = 1/2 is of order 2 while nothing switches, without damping; theta = 1 is of
# order 1 and damps what is faster than a step.
METHODS = tuple(
    fixed_step(
        name,
        partial(run_moreau_jean, theta=theta),
        smooth=(math.inf, partial(energy_factor, theta=theta)),
    )
    for name, theta in (("moreau_jean_half", 0.5), ("moreau_jean_one", 1.0))
)
