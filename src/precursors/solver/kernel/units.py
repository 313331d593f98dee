"""A chain in the kernel's units: spring constants (Eqs. 2 and 3), friction (Eqs. 5 and 6), tau."""

from __future__ import annotations

import math

import numpy as np

from precursors.model.chain import Chain
from precursors.solver.kernel.arrays import System, n_columns
from precursors.solver.kernel.compiled import unfused


def parameters(chain: Chain) -> tuple[float, ...]:
    """Numbers that `set_up` takes of a chain beside its weights."""
    return (
        chain.mass,
        chain.stiffness,
        chain.drive_stiffness,
        chain.drive_velocity,
        chain.mu_s,
        chain.mu_k,
    )


def scale(chain: Chain) -> System:
    """Express a chain in the kernel's units."""
    columns = np.zeros((3, n_columns(chain.n_blocks)))
    tau, speed, drive_velocity = set_up.py_func(parameters(chain), chain.weights, chain.n_blocks, columns)
    return System(chain.n_blocks, tau, speed, drive_velocity, *columns)


@unfused
def set_up(parameters, weights, n_blocks, columns):
    """Fill a chain's columns in the kernel's units; return tau [s], N/tau in m/s, and the drive's velocity.

    1/tau is Gershgorin's bound of the largest frequency: a row of a Taylor series is at most as large as the
    row two before it.
    """
    coupling, strength, friction = columns
    mass, stiffness, drive_stiffness, drive_velocity, mu_s, mu_k = parameters
    stiffest = 0.0
    for i in range(n_blocks):
        behind = stiffness if i > 0 else drive_stiffness
        ahead = stiffness if i < n_blocks - 1 else 0.0
        stiffest = max(stiffest, behind + ahead + (behind if i > 0 else 0.0) + ahead)
    tau = math.sqrt(mass / stiffest)
    for i in range(n_blocks):
        spring = stiffness if i > 0 else drive_stiffness
        coupling[i + 1] = spring * (tau * tau / mass)
        strength[i + 1] = mu_s * weights[i]
        friction[i + 1] = mu_k * weights[i]
    return tau, tau / mass, drive_velocity * mass / tau
