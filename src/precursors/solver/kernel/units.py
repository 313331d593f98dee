"""Convert a chain to the kernel's units: springs (Eqs. 2 and 3), friction (Eqs. 5 and
6) and tau."""

import math
from operator import attrgetter

from precursors.solver.kernel.arrays import (
    COUPLING,
    FRICTION,
    RATE,
    SLIDES,
    STRENGTH,
    System,
)
from precursors.solver.kernel.decorators import unfused

# Parameters of a chain that `set_up` needs, apart from its weights.
parameters = attrgetter(
    "mass", "stiffness", "drive_stiffness", "drive_velocity", "mu_s", "mu_k"
)


@unfused
def set_up(parameters, weights, motion):
    """Fill the rows of a chain and its drive (column 0); return it in the kernel's
    units.

    1/tau is Gershgorin's bound of the largest frequency. A row of a Taylor series is
    therefore not larger than the row two before it.
    """
    mass, stiffness, drive_stiffness, drive_velocity, mu_s, mu_k = parameters
    n_blocks = weights.shape[0]
    stiffest = (
        drive_stiffness + stiffness + stiffness if n_blocks > 1 else drive_stiffness
    )
    if n_blocks > 2:
        stiffest = max(stiffest, 4.0 * stiffness)
    tau = math.sqrt(mass / stiffest)
    for i in range(n_blocks):
        spring = stiffness if i > 0 else drive_stiffness
        motion[COUPLING, i + 1] = spring * (tau * tau / mass)
        motion[STRENGTH, i + 1] = mu_s * weights[i]
        motion[FRICTION, i + 1] = mu_k * weights[i]
    motion[RATE, 0] = drive_velocity * mass / tau
    motion[SLIDES, 0] = 1.0
    return System(n_blocks, tau, tau / mass, drive_velocity * mass / tau)
