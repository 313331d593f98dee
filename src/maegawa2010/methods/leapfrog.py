"""Velocity Verlet (leapfrog): fixed steps of one evaluation, which keep a mode's energy up
to their limit (L. Verlet, Phys. Rev. 159, 1967, 98-103).

Stick and slip are switched once a step, as with `rk4`; while all blocks stick the wait
is in closed form.
"""

import math

from maegawa2010.methods.compiled import inner, outer
from maegawa2010.methods.equations import accelerate, stretch
from maegawa2010.methods.fixed_step import run_in_steps
from maegawa2010.methods.march import fixed_step

LIMIT = 2.0  # largest stable omega dt


def energy_factor(z: float) -> float:
    """Factor on the energy in a step in the long run, z = omega dt: 1 up to the
    limit."""
    return math.exp(2.0 * math.acosh(max(0.5 * z * z - 1.0, 1.0)))


@inner
def leapfrog_step(system, state, last, h, _work):
    """Half a step of the forces, a step of the motion, half a step of the forces."""
    accelerate(state, last, 0.5 * h)
    stretch(system, state, last, h)
    accelerate(state, last, 0.5 * h)
    return 1


@outer
def run_leapfrog(motion, step):
    """Run with a step [s], see `run_in_steps`.

    The forces at the end of a step are those at the start of the next: one evaluation
    a step, and one more where friction has changed in between.
    """
    run_in_steps(motion, step, leapfrog_step, 1, 0.0)


METHODS = (fixed_step("leapfrog", run_leapfrog, smooth=(LIMIT, energy_factor)),)
