"""Friction as a part of the right-hand side, by Karnopp's dead zone or Eq. 4 as
printed, with RK4's steps.

Karnopp: a block slower than a small velocity dv counts as resting. It does not stretch
the springs, and its friction balances their force up to mu_s w; outside, friction is
mu_k w against the velocity. There are no modes: the law is evaluated four times a step
(D. Karnopp, J. Dyn. Syst. Meas. Control 107, 1985, 100-103).

Eq. 4 taken literally is the same with dv = 0: friction is static where the velocity is
exactly zero, and nowhere else. A velocity that crosses zero between two evaluations is
never exactly zero, so a block that has once slid never sticks again: it trembles about
zero by what a step changes its velocity, and creeps in proportion. With the paper's
drive the load then never exceeds mu_s w_1 at steps from 1e-7 s on (theta <= 0); at
finer ones it rises past it, without slips."""

from __future__ import annotations

import math
from functools import partial
from typing import Any

from maegawa2010.methods.columns import (
    DEAD_ZONE,
    INVERSE_MASS,
    KINETIC,
    MODE,
    STRENGTH,
    VELOCITY,
)
from maegawa2010.methods.common import Method, Result
from maegawa2010.methods.compiled import inner, outer
from maegawa2010.methods.fixed_step import (
    STEPS_IN_LEG,
    all_keep_their_modes,
    begin_leg,
    record_transition,
    step_length,
)
from maegawa2010.methods.march import march
from maegawa2010.methods.rk4 import room, step_of_law
from precursors.model.chain import Chain
from precursors.model.checks import not_negative, positive

# Part of the width that is certainly safe, found by trial: below 0.1 blocks jump over
# the zone, above 0.2 the error grows for nothing.
PART_OF_SAFE_WIDTH = 0.15


def safe_width(chain: Chain, step: float) -> float:
    """Dead zone dv [m/s] that no block can jump over in a step on its way to rest.

    Where the springs' force is within mu_s w, a sliding block slows down by at most
    (mu_s + mu_k) w h / m a step, and the zone is 2 dv wide.
    """
    slowdown = (chain.strength + chain.kinetic_friction).max() / chain.mass
    return 0.5 * step * float(slowdown)


def release_delay(chain: Chain, dead_zone: float) -> float:
    """Time [s] for which block 1, alone at its limit, creeps in the dead zone: m dv = K
    V t^2 / 2.

    The error of Karnopp's method is this delay's, of the order of the square root of
    the width.
    """
    return math.sqrt(2.0 * chain.mass * dead_zone / chain.loading_rate)


def solve(
    chain: Chain,
    duration: float,
    step: float,
    until: str | None = None,
    dead_zone: float | None = None,
    **limits: Any,
) -> Result:
    """Integrate with a dead zone of some velocity [m/s], by default
    `PART_OF_SAFE_WIDTH` of `safe_width`."""
    if dead_zone is None:
        dead_zone = PART_OF_SAFE_WIDTH * safe_width(chain, positive("step", step, "s"))
    width = not_negative("dead_zone", dead_zone, "m/s")
    method = partial(run_karnopp, dead_zone=width)
    return march(method, chain, duration, step, until, **limits)


@inner
def by_velocity(system, _state, i, net, velocity):
    """The law of friction with the dead zone; at dv = 0 it is Eqs. 4-6 as printed."""
    if abs(velocity) <= system[DEAD_ZONE, i]:
        held = min(max(net, -system[STRENGTH, i]), system[STRENGTH, i])
        return 0.0, system[INVERSE_MASS, i] * (net - held)
    friction = math.copysign(system[KINETIC, i], velocity)
    return velocity, system[INVERSE_MASS, i] * (net - friction)


@outer
def slide(system, state, h, n_steps):
    """Make n steps of the whole chain, with nothing recorded."""
    n = state.shape[1] - 2
    work = room(state)
    for _ in range(n_steps):
        step_of_law(by_velocity, system, state, n, h, work)


@inner
def record_modes(motion, dead_zone):
    """Record the blocks that have entered, left or crossed the dead zone in a step;
    whether there are any."""
    state = motion.state
    progress = motion.progress[0]
    known = progress.transitions
    for i in range(1, state.shape[1] - 1):
        old = state[MODE, i]
        velocity = state[VELOCITY, i]
        new = 0.0 if abs(velocity) <= dead_zone else math.copysign(1.0, velocity)
        if new != old:
            state[MODE, i] = new
            progress.sliding += int(abs(new) - abs(old))
            record_transition(motion, i, int(new))
    return progress.transitions > known


@outer
def run_karnopp(motion, step, dead_zone):
    """Run in steps with the law in each evaluation."""
    system = motion.system
    state = motion.state
    progress = motion.progress[0]
    n = state.shape[1] - 2
    work = room(state)
    system[DEAD_ZONE] = dead_zone
    # No block is released: its velocity decides.
    while begin_leg(motion, all_keep_their_modes(system, state, n), False):
        for _ in range(STEPS_IN_LEG):
            h = step_length(progress, step)
            progress.evaluations += step_of_law(by_velocity, system, state, n, h, work)
            progress.elapsed += h
            if record_modes(motion, dead_zone) or h < step or progress.sliding == 0:
                break


METHODS = (Method("karnopp", "step [s]", solve),)
