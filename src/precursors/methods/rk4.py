"""The classical Runge-Kutta method with a fixed step; stick and slip are switched once a step."""

from __future__ import annotations

import math

from precursors.methods.columns import by_mode, inner, outer, rates, rows
from precursors.methods.fixed_step import fixed_step, run_in_steps

STEPS = (1e-5, 3e-6, 1e-6, 3e-7, 1e-7, 3e-8, 1e-8, 3e-9, 1e-9)
LIMIT = 2.0 * math.sqrt(2.0)  # largest stable omega dt


def energy_factor(z: float) -> float:
    """Factor on the energy in a step, z = omega dt: |1 + iz - z^2/2 - iz^3/6 + z^4/24|^2."""
    return 1.0 - z**6 / 72.0 + z**8 / 576.0


@inner
def rk4_step(system, state, last, h, work):
    """One step h [s] of blocks 1..last: four evaluations (W. Kutta, Z. Math. Phys. 46, 1901, 435-453)."""
    return step_of_law(by_mode, 0.0, system, state, last, h, work)


@inner
def step_of_law(law, parameter, system, state, last, h, work):
    """The same under a law of friction, see `rates`."""
    force, velocity = state.spring_force, state.velocity
    rates(law, parameter, system, state, last, force, velocity, work[4], work[5])
    step_from_rates(law, parameter, system, state, last, h, work)
    return 4


@inner
def step_from_rates(law, parameter, system, state, last, h, work):
    """One step whose first evaluation is already in rows 4 and 5 of `work`."""
    force, velocity = state.spring_force, state.velocity
    force_sum, velocity_sum, force_trial, velocity_trial = work[0], work[1], work[2], work[3]
    first_force_rate, first_acceleration = work[4], work[5]
    for i in range(1, last + 2):
        force_sum[i] = force[i] + h / 6.0 * first_force_rate[i]
        velocity_sum[i] = velocity[i] + h / 6.0 * first_acceleration[i]
        force_trial[i] = force[i] + h / 2.0 * first_force_rate[i]
        velocity_trial[i] = velocity[i] + h / 2.0 * first_acceleration[i]
    stage(law, parameter, system, state, last, h / 3.0, h / 2.0, work)
    stage(law, parameter, system, state, last, h / 3.0, h, work)
    stage(law, parameter, system, state, last, h / 6.0, 0.0, work)
    for i in range(1, last + 2):
        force[i], velocity[i] = force_sum[i], velocity_sum[i]


@inner
def stage(law, parameter, system, state, last, share, ahead, work):
    """Evaluate the rates of the trial state as `rates`, add their share, make the next trial state.

    One loop: for short chains, rows of their own for the rates cost more than the sums.
    """
    force, velocity = state.spring_force, state.velocity
    force_sum, velocity_sum, force_trial, velocity_trial = work[0], work[1], work[2], work[3]
    velocity_behind, force_here = velocity_trial[0], force_trial[1]
    for i in range(1, last + 1):
        force_ahead = force_trial[i + 1]
        net = force_here - force_ahead
        velocity_here, acceleration = law(system, state, i, net, velocity_trial[i], parameter)
        force_rate = system.spring[i] * (velocity_behind - velocity_here)
        force_sum[i] += share * force_rate
        velocity_sum[i] += share * acceleration
        force_trial[i] = force[i] + ahead * force_rate
        velocity_trial[i] = velocity[i] + ahead * acceleration
        velocity_behind, force_here = velocity_here, force_ahead
    force_rate = system.spring[last + 1] * velocity_behind
    force_sum[last + 1] += share * force_rate
    force_trial[last + 1] = force[last + 1] + ahead * force_rate


@outer
def run_rk4(motion, step, waits):
    """Run with a step [s], see `run_in_steps`."""
    return run_in_steps(motion, step, waits, rk4_step, False, rows(motion.state, 6))


SMOOTH = (4, LIMIT, energy_factor)
METHODS = (
    fixed_step(
        "rk4", "RK4, every step", run_rk4, False, values=STEPS[:5], smooth=SMOOTH, color="#00573F", marker="p"
    ),
    fixed_step(
        "rk4_skip",
        "RK4",
        run_rk4,
        True,
        values=STEPS,
        whole=(1e-6, 1e-7, 3e-8, 1e-8, 3e-9),
        quick=(1e-6, 1e-7, 1e-8, 3e-9),
        quick_whole=(1e-6, 1e-7),
        smooth=SMOOTH,
        color="#009E73",
        marker="h",
    ),
)
