"""The classical Runge-Kutta method with a fixed step; stick and slip are switched once a step."""

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
    all_keep_their_modes,
    begin_leg,
    inner,
    outer,
    rates,
    step_length,
    switch,
)

STEPS = (1e-5, 3e-6, 1e-6, 3e-7, 1e-7, 3e-8, 1e-8, 3e-9, 1e-9)


@inner
def new_scratch(state):
    """Room for the rows that a step works on: sums and trial states of T and v, and the first rates."""
    scratch = np.zeros((6, state.tension.shape[0]))
    scratch[3, 0] = state.velocity[0]
    return scratch


@inner
def rk4_step(system, state, last, h, scratch):
    """One step h [s] of blocks 1..last: four evaluations (W. Kutta, Z. Math. Phys. 46, 1901, 435-453)."""
    rates(system, state, last, state.tension, state.velocity, scratch[4], scratch[5])
    rk4_from_rates(system, state, last, h, scratch)


@inner
def rk4_from_rates(system, state, last, h, scratch):
    """One step whose first evaluation is already in rows 4 and 5 of the scratch."""
    tension, velocity = state.tension, state.velocity
    sum_t, sum_v, trial_t, trial_v = scratch[0], scratch[1], scratch[2], scratch[3]
    first_t, first_v = scratch[4], scratch[5]
    for i in range(1, last + 2):
        sum_t[i] = tension[i] + h / 6.0 * first_t[i]
        sum_v[i] = velocity[i] + h / 6.0 * first_v[i]
        trial_t[i] = tension[i] + h / 2.0 * first_t[i]
        trial_v[i] = velocity[i] + h / 2.0 * first_v[i]
    stage(system, state, last, h / 3.0, h / 2.0, sum_t, sum_v, trial_t, trial_v)
    stage(system, state, last, h / 3.0, h, sum_t, sum_v, trial_t, trial_v)
    stage(system, state, last, h / 6.0, 0.0, sum_t, sum_v, trial_t, trial_v)
    for i in range(1, last + 2):
        tension[i], velocity[i] = sum_t[i], sum_v[i]


@inner
def stage(system, state, last, share, ahead, sum_t, sum_v, trial_t, trial_v):
    """Evaluate the rates of the trial state as `forces.rates`, add their share, make the next trial state.

    One loop: for short chains, rows of their own for the rates cost more than the sums.
    """
    spring, mobility, push = system.spring, state.mobility, state.push
    tension, velocity = state.tension, state.velocity
    v_behind, t_behind = trial_v[0], trial_t[1]
    for i in range(1, last + 1):
        v, t_ahead = trial_v[i], trial_t[i + 1]
        d_tension = spring[i] * (v_behind - v)
        d_velocity = mobility[i] * (t_behind - t_ahead - push[i])
        sum_t[i] += share * d_tension
        sum_v[i] += share * d_velocity
        trial_t[i] = tension[i] + ahead * d_tension
        trial_v[i] = velocity[i] + ahead * d_velocity
        v_behind, t_behind = v, t_ahead
    d_tension = spring[last + 1] * v_behind
    sum_t[last + 1] += share * d_tension
    trial_t[last + 1] = tension[last + 1] + ahead * d_tension


@outer
def slide(system, state, h, n_steps):
    """Make n steps of all blocks as they slide, without switching: the smooth method alone."""
    scratch = new_scratch(state)
    for _ in range(n_steps):
        rk4_step(system, state, state.mode.shape[0] - 2, h, scratch)


@outer
def run_rk4(system, state, record, clock, count, duration, until_global, step, skipping):
    """Run until `duration` [s], the end of the first global slip, a full record or a spent budget.

    A block whose velocity has changed its sign at the end of a step is stopped there, and sticks or turns
    round; a stuck block whose force exceeds mu_s w at the end of a step lets go there. While all blocks stick
    each step is made as well, or (`skipping`) the wait is in closed form.
    """
    scratch = new_scratch(state)
    for _ in range(LEGS_PER_CALL):
        status = begin_leg(system, state, record, clock, count, duration, until_global, skipping)
        if status != MOVING:
            return status
        for _ in range(STEPS_IN_LEG):
            h = step_length(clock, duration, step)
            rk4_step(system, state, count[LAST], h, scratch)
            count[EVALUATIONS] += 4
            clock[ELAPSED] += h
            if h < step or not all_keep_their_modes(system, state, count[LAST]):
                break
        switch(system, state, record, clock, count)
    return PAUSED


METHODS = (
    fixed_step("rk4", "RK4, every step", STEPS[:5], run_rk4, False),
    fixed_step("rk4_skip", "RK4", STEPS, run_rk4, True),
)
