"""Karnopp's dead zone: a block slower than a small velocity counts as resting (D. Karnopp, 1985).

Inside the zone |v| <= dv a block does not stretch the springs, and its friction balances their force up to
mu_s w; outside, friction is mu_k w against the velocity. There are no modes: the law is part of the
right-hand side, which the Runge-Kutta method with a fixed step evaluates four times a step.

J. Dyn. Syst. Meas. Control 107 (1985) 100-103.
"""

from __future__ import annotations

import math

import numpy as np

from precursors.methods.common import Method, Result, march
from precursors.methods.forces import (
    ELAPSED,
    EVALUATIONS,
    FINISHED,
    GLOBAL,
    LEGS_PER_CALL,
    MOVING,
    PAUSED,
    SLIDING,
    STEPS_IN_LEG,
    apart,
    inner,
    note,
    obstacle,
    outer,
    rest,
    step_length,
)
from precursors.model.chain import Chain, not_negative, positive

# Part of the width that is safe for certain; by trial: below 0.1 blocks get through, above 0.2 more is wrong.
PART_OF_SAFE_WIDTH = 0.15
STEPS = (3e-6, 1e-6, 3e-7, 1e-7, 3e-8, 1e-8, 3e-9, 1e-9)


@inner
def rates_with_law(system, n_blocks, dead_zone, tension, velocity, d_tension, d_velocity):
    """Right-hand side with the dead zone; at dv = 0 it is Eqs. 2-6 as printed."""
    seen_behind = velocity[0]
    for i in range(1, n_blocks + 1):
        net = tension[i] - tension[i + 1]
        v = velocity[i]
        if abs(v) <= dead_zone:
            seen, friction = 0.0, min(max(net, -system.strength[i]), system.strength[i])
        else:
            seen, friction = v, system.friction[i] if v > 0.0 else -system.friction[i]
        d_tension[i] = system.spring[i] * (seen_behind - seen)
        d_velocity[i] = system.inverse_mass * (net - friction)
        seen_behind = seen
    d_tension[n_blocks + 1] = 0.0


@inner
def new_scratch(state):
    """Room for the six rows that a step works on: sums, trial states and rates of T and v."""
    scratch = np.zeros((6, state.tension.shape[0]))
    scratch[3, 0] = state.velocity[0]
    return scratch


@inner
def law_step(system, state, n_blocks, h, dead_zone, scratch):
    """One step h [s] of the classical Runge-Kutta method, with the law of friction in each evaluation."""
    sum_t, sum_v, trial_t, trial_v = scratch[0], scratch[1], scratch[2], scratch[3]
    d_t, d_v = scratch[4], scratch[5]
    for i in range(1, n_blocks + 1):
        sum_t[i] = trial_t[i] = state.tension[i]
        sum_v[i] = trial_v[i] = state.velocity[i]
    for stage in range(4):
        rates_with_law(system, n_blocks, dead_zone, trial_t, trial_v, d_t, d_v)
        share = h / 3.0 if 0 < stage < 3 else h / 6.0
        ahead = h if stage == 2 else 0.5 * h
        for i in range(1, n_blocks + 1):
            sum_t[i] += share * d_t[i]
            sum_v[i] += share * d_v[i]
            trial_t[i] = state.tension[i] + ahead * d_t[i]
            trial_v[i] = state.velocity[i] + ahead * d_v[i]
    for i in range(1, n_blocks + 1):
        state.tension[i], state.velocity[i] = sum_t[i], sum_v[i]


@outer
def slide(system, state, h, n_steps, dead_zone):
    """Make n steps of the whole chain, with nothing recorded."""
    n_blocks = state.mode.shape[0] - 2
    scratch = new_scratch(state)
    for _ in range(n_steps):
        law_step(system, state, n_blocks, h, dead_zone, scratch)


@inner
def mode_of(v, dead_zone):
    """Mode of a block with velocity v: in the dead zone it counts as resting."""
    if abs(v) <= dead_zone:
        return 0
    return 1 if v > 0.0 else -1


@inner
def all_keep_their_modes(state, n_blocks, dead_zone):
    """Whether no block has entered, left or crossed the dead zone."""
    changes = 0
    for i in range(1, n_blocks + 1):
        changes += mode_of(state.velocity[i], dead_zone) != state.mode[i]
    return changes == 0


@apart
def note_modes(state, record, clock, count, n_blocks, dead_zone):
    """Record the blocks that have entered, left or crossed the dead zone in a step."""
    for i in range(1, n_blocks + 1):
        old, new = state.mode[i], mode_of(state.velocity[i], dead_zone)
        if new != old:
            state.mode[i] = new
            note(state, record, clock, count, i, new)
            count[SLIDING] += abs(new) - abs(old)
            if count[SLIDING] == n_blocks:
                count[GLOBAL] = 1


@apart
def begin_leg(system, state, record, clock, count, duration, until_global):
    """Whether steps are to be made (MOVING) or why not; where all blocks rest, wait."""
    status = obstacle(state, record, count)
    if status == MOVING and count[SLIDING] == 0 and all_hold(system, state, state.mode.shape[0] - 2):
        status = rest(system, state, clock, count, duration, until_global, True)
    if status == MOVING and step_length(clock, duration, duration) <= 0.0:
        return FINISHED
    return status


@inner
def all_hold(system, state, n_blocks):
    """Whether no force exceeds mu_s w."""
    for i in range(1, n_blocks + 1):
        if abs(state.tension[i] - state.tension[i + 1]) > system.strength[i]:
            return False
    return True


@outer
def run_karnopp(system, state, record, clock, count, duration, until_global, step, dead_zone):
    """Run until `duration` [s], the end of the first global slip, a full record or a spent budget."""
    n_blocks = state.mode.shape[0] - 2
    scratch = new_scratch(state)
    for _ in range(LEGS_PER_CALL):
        status = begin_leg(system, state, record, clock, count, duration, until_global)
        if status != MOVING:
            return status
        for _ in range(STEPS_IN_LEG):
            h = step_length(clock, duration, step)
            law_step(system, state, n_blocks, h, dead_zone, scratch)
            count[EVALUATIONS] += 4
            clock[ELAPSED] += h
            if h < step or count[SLIDING] == 0 or not all_keep_their_modes(state, n_blocks, dead_zone):
                break
        note_modes(state, record, clock, count, n_blocks, dead_zone)
    return PAUSED


def safe_width(chain: Chain, step: float) -> float:
    """Dead zone dv [m/s] that no block can jump over in a step on its way to rest.

    Where the springs' force is within mu_s w, a sliding block slows down by at most (mu_s + mu_k) w h / m a
    step, and the zone is 2 dv wide.
    """
    slowdown = (chain.strength + chain.kinetic_friction).max() / chain.mass
    return 0.5 * step * float(slowdown)


def release_delay(chain: Chain, dead_zone: float) -> float:
    """Time [s] for which block 1, alone at its limit, creeps in the dead zone: m dv = K V t^2 / 2.

    The error of Karnopp's method is this delay's, of the order of the square root of the width.
    """
    return math.sqrt(2.0 * chain.mass * dead_zone / chain.loading_rate)


def solve(
    chain: Chain, duration: float, step: float, until: str | None = None, dead_zone: float | None = None
) -> Result:
    """Integrate with a dead zone of some velocity [m/s], by default `PART_OF_SAFE_WIDTH` of `safe_width`.

    While all blocks rest the wait is in closed form.

    Raises
    ------
    ValueError, DivergedError, TransitionLimitError
        As `march`.
    """
    if dead_zone is None:
        dead_zone = PART_OF_SAFE_WIDTH * safe_width(chain, positive("step", step, "s"))
    width = not_negative("dead_zone", dead_zone, "m/s")
    return march(run_karnopp, (width,), chain, duration, step, until)


METHODS = (Method("karnopp", "Karnopp's dead zone", "step [s]", STEPS, solve),)
