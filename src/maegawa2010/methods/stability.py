"""Where fixed-step methods become unstable: measured energy growth per step.

The energy of a chain without friction whose drive rests is constant. A method multiplies
the energy of a mode with angular frequency omega by a factor in each step,
`Smooth.energy_factor(omega dt)`. As dt grows, the factor first exceeds 1 for the fastest
mode, at omega dt = `Smooth.limit`.
"""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from maegawa2010.methods.columns import FORCE, VELOCITY, sliding_forward
from precursors.model.chain import Chain, FloatArray
from precursors.model.statics import balance_matrix

# A drive this slow does no measurable work. `Chain` refuses a velocity of zero.
AT_REST = float(np.finfo(float).eps)  # m/s

Slide = Callable[..., None]


def without_friction(chain: Chain) -> Chain:
    """The chain without friction and with a drive that (almost) rests: its energy is
    constant."""
    return replace(chain, mu_s=0.0, mu_k=0.0, drive_velocity=AT_REST)


def stiffness_matrix(chain: Chain) -> FloatArray:
    """Stiffness of the chain with the drive at rest [N/m], shape (N, N), from the springs
    of Eqs. 2-4."""
    n = chain.n_blocks
    return balance_matrix(chain) @ (np.eye(n) - np.eye(n, k=-1))


def highest_frequency(chain: Chain) -> float:
    """Largest angular frequency of the chain with all blocks sliding [rad/s], including
    the drive's spring."""
    return float(np.sqrt(np.linalg.eigvalsh(stiffness_matrix(chain))[-1] / chain.mass))


def highest_mode(chain: Chain) -> FloatArray:
    """Mode of the highest frequency: displacements of the blocks, shape (N,), norm 1."""
    return np.linalg.eigh(stiffness_matrix(chain))[1][:, -1]


def energy(chain: Chain, state: FloatArray) -> float:
    """Kinetic and elastic energy [J]."""
    force = state[FORCE, 1:-1]
    velocity = state[VELOCITY, 1:-1]
    return 0.5 * float(
        chain.mass * velocity @ velocity + (force**2 / chain.springs).sum()
    )


def energy_left(
    chain: Chain, slide: Slide, step: float, n_steps: int, velocities: FloatArray
) -> float:
    """Energy after `n_steps` steps [s] in which all blocks slide from given velocities
    [m/s], over the energy at the start."""
    system, state = sliding_forward(chain, velocities)
    before = energy(chain, state)
    slide(system, state, step, n_steps)
    with np.errstate(over="ignore", invalid="ignore"):
        return energy(chain, state) / before
