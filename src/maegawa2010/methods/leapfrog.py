"""Velocity Verlet (leapfrog): fixed steps with one evaluation, which conserve the energy
of a mode up to the stability limit (L. Verlet, Phys. Rev. 159, 1967, 98-103).

Transitions are made at the end of a step, as with `rk4`; waits while all blocks stick are
skipped in closed form.
"""

import math

from maegawa2010.methods.compiled import inner, outer
from maegawa2010.methods.equations import accelerate, stretch
from maegawa2010.methods.fixed_step import run_in_steps
from maegawa2010.methods.march import fixed_step

LIMIT = 2.0  # largest stable omega dt


def energy_factor(z: float) -> float:
    """Mean factor on the energy of a mode in a step, z = omega dt: 1 up to the limit."""
    return math.exp(2.0 * math.acosh(max(0.5 * z * z - 1.0, 1.0)))


@inner
def leapfrog_step(system, state, last, h, _work):
    """Make a step: half a step of the velocities, a step of the springs, half a step of the
    velocities."""
    accelerate(state, last, 0.5 * h)
    stretch(system, state, last, h)
    accelerate(state, last, 0.5 * h)
    return 1


@outer
def run_leapfrog(motion, step):
    """Run with a step [s], see `run_in_steps`.

    The forces at the end of a step serve at the start of the next: one evaluation per
    step, and one more after each transition.
    """
    run_in_steps(motion, step, leapfrog_step, 1, 0.0)


METHODS = (fixed_step("leapfrog", run_leapfrog, smooth=(LIMIT, energy_factor)),)
