"""A chain in the kernel's units: spring constants (Eqs. 2 and 3), friction (Eqs. 5 and
6), tau."""

import math
from operator import attrgetter

from precursors.solver.kernel.arrays import System, vectors_in
from precursors.solver.kernel.decorators import inner, unfused

# Numbers that `set_up` takes of a chain beside its weights.
parameters = attrgetter(
    "mass", "stiffness", "drive_stiffness", "drive_velocity", "mu_s", "mu_k"
)


@inner
def lay_out(parameters, weights, memory):
    """The system and the motion of a chain in memory; column 0 is the drive."""
    columns, motion = vectors_in(memory, weights.shape[0])
    chain = set_up(parameters, weights, columns)
    motion.rate[0] = chain.drive_velocity
    motion.slides[0] = 1.0
    return chain, motion


@unfused
def set_up(parameters, weights, columns):
    """Fill the columns of a chain, which are zero, and return it in the kernel's units.

    1/tau is Gershgorin's bound of the largest frequency: a row of a Taylor series is at
    most as large as the row two before it.
    """
    coupling, strength, friction = columns
    mass, stiffness, drive_stiffness, drive_velocity, mu_s, mu_k = parameters
    n_blocks = weights.shape[0]
    stiffest = (
        drive_stiffness + stiffness + stiffness if n_blocks > 1 else drive_stiffness
    )
    if n_blocks > 2:
        stiffest = max(stiffest, 4.0 * stiffness)
    tau = math.sqrt(mass / stiffest)
    for i in range(n_blocks):
        coupling[i + 1] = (stiffness if i > 0 else drive_stiffness) * (tau * tau / mass)
        strength[i + 1] = mu_s * weights[i]
        friction[i + 1] = mu_k * weights[i]
    return System(
        n_blocks,
        tau,
        tau / mass,
        drive_velocity * mass / tau,
        coupling,
        strength,
        friction,
    )
