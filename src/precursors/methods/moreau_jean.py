"""Moreau-Jean time stepping: implicit springs, friction as a set-valued law of the velocity at a step's end.

M. Jean, Comput. Methods Appl. Mech. Engrg. 177 (1999) 235-257; V. Acary and B. Brogliato, Numerical Methods
for Nonsmooth Dynamical Systems (2008). With the spring forces at the part theta of the step,

    m (v' - v) = h (T*_i - T*_{i+1} - R_i),
    T* = T + theta h c_i (u_{i-1} - u_i),  u = theta v' + (1 - theta) v,

the friction R_i of a block is mode_i mu_k w_i where v' has the sign of its mode, and anything up to mu_s w_i
where v' = 0. As mu_s > mu_k both can be true: a block that stuck at the last step sticks, one that slid
slides. The modes are found by an active set: solve the tridiagonal system for the blocks that slide, stop
those that go against their mode, let those go whose R exceeds mu_s w, until nothing changes.
"""

from __future__ import annotations

import numpy as np

from precursors.methods.common import fixed_step
from precursors.methods.forces import (
    ELAPSED,
    EVALUATIONS,
    LAST,
    LEGS_PER_CALL,
    MOVING,
    PAUSED,
    STEPS_IN_LEG,
    TRANSITIONS,
    begin_leg,
    change_mode,
    inner,
    outer,
    set_mode,
    step_length,
)

STEPS = (3e-5, 1e-5, 3e-6, 1e-6, 3e-7, 1e-7, 3e-8, 1e-8, 3e-9, 1e-9)
# theta: of order 2 while nothing switches, without damping; of order 1, damping what is faster than a step.
TRAPEZOIDAL, IMPLICIT = 0.5, 1.0
# The active set settles in two or three solutions; where it goes in a circle, this many are enough.
SOLUTIONS_PER_BLOCK = 4


@inner
def new_scratch(state):
    """Room for four rows: forces without the new velocities, new velocities, and elimination's two."""
    scratch = np.zeros((4, state.tension.shape[0]))
    scratch[1, 0] = state.velocity[0]
    return scratch


@inner
def explicit_forces(system, state, last, h, theta, known):
    """Spring forces T* without the share of the new velocities."""
    tension, velocity, spring = state.tension, state.velocity, system.spring
    part = theta * (1.0 - theta) * h
    for i in range(1, last + 2):
        known[i] = tension[i] + part * spring[i] * (velocity[i - 1] - velocity[i])
    known[last + 2 :] = tension[last + 2 :]


@inner
def solve_velocities(system, state, last, h, theta, scratch):
    """New velocities of the blocks 1..last that slide, by elimination of the tridiagonal system."""
    known, new, factor, value = scratch[0], scratch[1], scratch[2], scratch[3]
    spring, velocity, mobility, push = system.spring, state.velocity, state.mobility, state.push
    factor[0], value[0] = 0.0, new[0]
    for i in range(1, last + 1):
        a = h * mobility[i]
        behind, ahead = a * theta * theta * h * spring[i], a * theta * theta * h * spring[i + 1]
        right = (velocity[i] if a > 0.0 else 0.0) + a * (known[i] - known[i + 1] - push[i])
        pivot = 1.0 / (1.0 + behind + ahead - behind * factor[i - 1])
        factor[i] = ahead * pivot
        value[i] = (right + behind * value[i - 1]) * pivot
    new[last + 1] = 0.0
    for i in range(last, 0, -1):
        new[i] = value[i] + factor[i] * new[i + 1]


@inner
def finish(system, state, last, h, theta, new):
    """Take over the new velocities and stretch the springs."""
    tension, velocity, spring = state.tension, state.velocity, system.spring
    for i in range(1, last + 2):
        before, after = velocity[i - 1] - velocity[i], new[i - 1] - new[i]
        tension[i] += h * spring[i] * (theta * after + (1.0 - theta) * before)
        if i > 1:
            velocity[i - 1] = new[i - 1]


@inner
def set_trial(system, state, trial, i, mode):
    """Give a block the mobility and the friction of a mode that is being tried."""
    trial[i] = mode
    state.mobility[i] = system.inverse_mass if mode != 0 else 0.0
    state.push[i] = mode * system.friction[i]


@inner
def holding_force(system, state, i, h, theta, known, new):
    """Friction R_i that keeps block i at v' = 0, or brings it there [N]."""
    spring, reach = system.spring, theta * theta * h
    behind = known[i] + reach * spring[i] * (new[i - 1] - new[i])
    ahead = known[i + 1] + reach * spring[i + 1] * (new[i] - new[i + 1])
    return behind - ahead + state.velocity[i] / (system.inverse_mass * h)


@inner
def step_modes(system, state, last, h, theta, scratch, trial):
    """Find modes and new velocities of a step; return the farthest sliding block and the solutions made."""
    n_blocks = state.mode.shape[0] - 2
    known, new = scratch[0], scratch[1]
    explicit_forces(system, state, last, h, theta, known)
    most = SOLUTIONS_PER_BLOCK * (n_blocks + 1)
    for solutions in range(1, most + 1):
        solve_velocities(system, state, last, h, theta, scratch)
        changed = False
        for i in range(1, min(last + 1, n_blocks) + 1):
            if trial[i] != 0:
                if new[i] * trial[i] < 0.0:
                    set_trial(system, state, trial, i, 0)
                    changed = True
            else:
                friction = holding_force(system, state, i, h, theta, known, new)
                if abs(friction) > system.strength[i]:
                    set_trial(system, state, trial, i, 1 if friction > 0.0 else -1)
                    changed = True
                    last = max(last, i)
        if not changed:
            return last, solutions
    return last, most


@outer
def slide(system, state, h, n_steps, theta):
    """Make n steps of all blocks as they slide, without switching: the smooth method alone."""
    n_blocks = state.mode.shape[0] - 2
    scratch = new_scratch(state)
    for _ in range(n_steps):
        explicit_forces(system, state, n_blocks, h, theta, scratch[0])
        solve_velocities(system, state, n_blocks, h, theta, scratch)
        finish(system, state, n_blocks, h, theta, scratch[1])


@outer
def run_moreau_jean(system, state, record, clock, count, duration, until_global, step, theta):
    """Run until `duration` [s], the end of the first global slip, a full record or a spent budget.

    A block that turns round needs a step to stop in, whose friction brakes it; a rest of one step between the
    two directions is recorded as the turn that it stands for. Each solution of the tridiagonal system counts
    as an evaluation.
    """
    scratch = new_scratch(state)
    trial = state.mode.copy()
    came_from, stop_record = np.zeros_like(trial), np.zeros_like(trial)
    stop_step = np.full_like(trial, -1)
    n_step = 0
    for _ in range(LEGS_PER_CALL):
        status = begin_leg(system, state, record, clock, count, duration, until_global, True)
        if status != MOVING:
            return status
        trial[1] = state.mode[1]
        last = count[LAST]
        for _ in range(STEPS_IN_LEG):
            n_step += 1
            h = step_length(clock, duration, step)
            last, solutions = step_modes(system, state, last, h, theta, scratch, trial)
            finish(system, state, last, h, theta, scratch[1])
            count[EVALUATIONS] += solutions
            clock[ELAPSED] += h
            if h < step or solutions > 1:
                break
        for i in range(1, last + 1):
            old, new = state.mode[i], trial[i]
            if new == 0:
                state.velocity[i] = 0.0
            if new == old:
                continue
            if stop_step[i] == n_step - 1 and new == -came_from[i]:
                set_mode(system, state, count, i, new)
                record.mode[stop_record[i]] = new
                continue
            if new == 0:
                came_from[i], stop_step[i], stop_record[i] = old, n_step, count[TRANSITIONS]
            change_mode(system, state, record, clock, count, i, new)
    return PAUSED


METHODS = (
    fixed_step("moreau_jean_half", "Moreau-Jean, trapezoidal", STEPS, run_moreau_jean, TRAPEZOIDAL),
    fixed_step("moreau_jean_one", "Moreau-Jean, implicit", STEPS, run_moreau_jean, IMPLICIT),
)
