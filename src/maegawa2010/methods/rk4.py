"""The classical Runge-Kutta method with a fixed step; stick and slip are switched once
a step."""

from __future__ import annotations

import math

import numpy as np

from maegawa2010.methods.columns import FORCE, SPRING, VELOCITY
from maegawa2010.methods.compiled import inner, outer, template
from maegawa2010.methods.equations import by_mode, copy, rates
from maegawa2010.methods.fixed_step import run_in_steps
from maegawa2010.methods.march import fixed_step

LIMIT = 2.0 * math.sqrt(2.0)  # largest stable omega dt


def energy_factor(z: float) -> float:
    """Factor on the energy in a step, z = omega dt: |1 + iz - z^2/2 - iz^3/6 +
    z^4/24|^2."""
    return 1.0 - z**6 / 72.0 + z**8 / 576.0


@template
def rk4_step(system, state, last, h, work):
    """One step h [s] of blocks 1..last: four evaluations (W. Kutta, Z. Math. Phys. 46,
    1901, 435-453)."""
    return step_of_law(by_mode, system, state, last, h, work)


@template
def step_of_law(law, system, state, last, h, work):
    """The same under a law of friction, see `rates`."""
    rate, _, end = work
    rates(law, system, state, last, state, rate)
    step_from_rates(law, system, state, last, h, work)
    copy(end, last, state)
    return 4


@inner
def step_from_rates(law, system, state, last, h, work):
    """Find the end of a step whose first rates are already in `work`."""
    rate, trial, end = work
    for i in range(1, last + 2):
        for row in range(2):
            end[row, i] = state[row, i] + h / 6.0 * rate[row, i]
            trial[row, i] = state[row, i] + h / 2.0 * rate[row, i]
    stage(law, system, state, last, h / 3.0, h / 2.0, work)
    stage(law, system, state, last, h / 3.0, h, work)
    stage(law, system, state, last, h / 6.0, 0.0, work)


@inner
def stage(law, system, state, last, share, ahead, work):
    """Evaluate the rates of the trial state as `rates`, add their share, make the next
    trial state.

    One loop: for short chains, to write down the rates costs more than the sums.
    """
    _, trial, end = work
    behind = trial[VELOCITY, 0]
    force = trial[FORCE, 1]
    for i in range(1, last + 1):
        force_ahead = trial[FORCE, i + 1]
        here, acceleration = law(
            system, state, i, force - force_ahead, trial[VELOCITY, i]
        )
        force_rate = system[SPRING, i] * (behind - here)
        end[FORCE, i] += share * force_rate
        end[VELOCITY, i] += share * acceleration
        trial[FORCE, i] = state[FORCE, i] + ahead * force_rate
        trial[VELOCITY, i] = state[VELOCITY, i] + ahead * acceleration
        behind = here
        force = force_ahead
    force_rate = system[SPRING, last + 1] * behind
    end[FORCE, last + 1] += share * force_rate
    trial[FORCE, last + 1] = state[FORCE, last + 1] + ahead * force_rate


@inner
def room(state):
    """Rates, a trial state and the state at the end of a step, to work in."""
    return np.zeros_like(state), state.copy(), state.copy()


@outer
def run_rk4(motion, step):
    """Run with a step [s], see `run_in_steps`."""
    run_in_steps(motion, step, rk4_step, 0, room(motion.state))


SMOOTH = (LIMIT, energy_factor)
METHODS = (
    fixed_step("rk4", run_rk4, waits=False, smooth=SMOOTH),
    fixed_step("rk4_skip", run_rk4, smooth=SMOOTH),
)
