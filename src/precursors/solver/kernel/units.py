"""A chain in the kernel's units: spring constants (Eqs. 2 and 3), friction (Eqs. 5 and 6), tau."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from precursors.model.chain import Chain, FloatArray
from precursors.solver.kernel.arrays import Additions, new_additions, new_columns
from precursors.solver.kernel.compiled import unfused
from precursors.solver.kernel.layout import REACH


class System(NamedTuple):
    """A chain in the kernel's units; columns as in the package's docstring."""

    tau: float
    drive_velocity: float
    coupling: FloatArray
    strength: FloatArray
    friction: FloatArray
    lightness: FloatArray
    additions: Additions | None


def is_linked(chain: Chain) -> bool:
    """Whether the compiled code has to know of `additions`: dashpots or interface springs."""
    return chain.viscosity > 0.0 or chain.interface_stiffness > 0.0


def parameters(chain: Chain) -> tuple[float, ...]:
    """What `set_up` takes of a chain beside its weights."""
    return (
        chain.mass,
        chain.stiffness,
        chain.drive_stiffness,
        chain.drive_velocity,
        chain.mu_s,
        chain.mu_k,
        chain.head_mass,
        chain.viscosity,
        chain.interface_stiffness,
    )


def scale(chain: Chain) -> System:
    """Express a chain in the kernel's units."""
    columns = new_columns(chain.n_blocks)
    additions = new_additions(chain.n_blocks) if is_linked(chain) else None
    tau, drive_velocity = set_up.py_func(parameters(chain), chain.weights, columns, additions)
    return System(tau, drive_velocity, *columns, additions)


@unfused
def set_up(parameters, weights, chain, additions):
    """Fill a chain's columns in the kernel's units; return tau [s] and the drive's velocity [N/tau].

    tau follows from Gershgorin's bounds: a row of a Taylor series is at most a times the row two before it,
    and b times the row before it, and a + b REACH <= REACH^2.
    """
    coupling, strength, friction, lightness = chain
    mass, stiffness, drive_stiffness, drive_velocity, mu_s, mu_k, head_mass, viscosity, anchorage = parameters
    n_blocks = weights.shape[0]
    stiffest = 0.0
    for i in range(n_blocks):
        behind = stiffness if i > 0 else drive_stiffness
        ahead = stiffness if i < n_blocks - 1 else 0.0
        stiffest = max(stiffest, behind + ahead + (behind if i > 0 else 0.0) + ahead)
    if additions is None:
        tau = REACH * math.sqrt(mass / stiffest)
    else:
        a, b = (stiffest + anchorage) / mass, 4.0 * viscosity / mass
        tau = 2.0 * REACH / (b + math.sqrt(b * b + 4.0 * a))
        for i in range(n_blocks):
            additions.dashpot[i + 1] = viscosity * (tau / mass) if i > 0 else 0.0
            additions.anchor[i + 1] = anchorage * (tau * tau / mass)
    for i in range(n_blocks):
        spring = stiffness if i > 0 else drive_stiffness
        coupling[i + 1] = spring * (tau * tau / mass)
        strength[i + 1] = mu_s * weights[i]
        friction[i + 1] = mu_k * weights[i]
        lightness[i + 1] = mass / (mass + head_mass) if i == 0 else 1.0
    return tau, drive_velocity * mass / tau


def to_positions(chain: Chain, times: FloatArray, force: FloatArray) -> FloatArray:
    """Positions [m], shape (T, N), from the spring forces at `times` [s]: x_1 = V t - T_1/K (Eq. 3), ..."""
    return chain.drive_velocity * times[:, None] - np.cumsum(force / chain.springs, axis=1)
