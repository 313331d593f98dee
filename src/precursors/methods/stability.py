"""Where fixed-step methods become unstable: the growth of energy, measured and in theory.

A chain without friction whose drive rests keeps its energy. With z = omega dt, a method multiplies the energy
of a mode of angular frequency omega by a factor a step; the fastest mode is the first whose factor exceeds 1.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from functools import partial

import numpy as np

from precursors.methods import leapfrog, moreau_jean, rk4
from precursors.methods.forces import State, sliding_forward, system_of
from precursors.model.chain import Chain, FloatArray

# (system, state, step [s], number of steps): the smooth method alone, see `slide` of the integrators.
Slide = Callable[..., None]
# By name in the table of methods.
SLIDES: dict[str, Slide] = {
    "rk4": rk4.slide,
    "leapfrog": partial(leapfrog.slide, verlet=True),
    "semi_implicit_euler": partial(leapfrog.slide, verlet=False),
    "moreau_jean_half": partial(moreau_jean.slide, theta=moreau_jean.TRAPEZOIDAL),
    "moreau_jean_one": partial(moreau_jean.slide, theta=moreau_jean.IMPLICIT),
}

# Largest stable omega dt, where the growth factors below reach 1.
RK4_LIMIT = 2.0 * math.sqrt(2.0)
LEAPFROG_LIMIT = 2.0

# Energy that grows so much within so many steps grows without limit. Bounded energy can rise by
# 1 / (1 - (omega dt / 2)^2) in leapfrog: 500 times at 0.1 % below its limit.
GROWTH = 1e6
STEPS = 4000
BISECTIONS = 20
# A drive so slow does no work in a test; `Chain` has none that rests.
AT_REST = 1e-15


def without_friction(chain: Chain) -> Chain:
    """The chain without friction and with a drive that (almost) rests: its energy stays as it is."""
    return replace(chain, mu_s=0.0, mu_k=0.0, drive_velocity=AT_REST)


def stiffness_matrix(chain: Chain) -> FloatArray:
    """Stiffness of the chain with the drive held [N/m], shape (N, N), from the springs of Eqs. 2-4."""
    ahead = np.append(chain.springs[1:], 0.0)
    return np.diag(chain.springs + ahead) - np.diag(chain.springs[1:], k=1) - np.diag(chain.springs[1:], k=-1)


def highest_frequency(chain: Chain) -> float:
    """Largest angular frequency of the chain with all blocks sliding [rad/s], the drive's spring included."""
    return float(np.sqrt(np.linalg.eigvalsh(stiffness_matrix(chain))[-1] / chain.mass))


def highest_mode(chain: Chain) -> FloatArray:
    """Shape (N,) of the motion of that frequency, of length 1."""
    return np.linalg.eigh(stiffness_matrix(chain))[1][:, -1]


def energy(chain: Chain, state: State) -> float:
    """Kinetic energy and that of the springs [J]."""
    springs = state.tension[1:-1] ** 2 / chain.springs
    return 0.5 * float(chain.mass * state.velocity[1:-1] @ state.velocity[1:-1] + springs.sum())


def energy_left(chain: Chain, slide: Slide, step: float, n_steps: int, velocities: FloatArray) -> float:
    """Energy after n steps of all blocks sliding from some velocities [m/s], over that at the start."""
    system = system_of(chain)
    state = sliding_forward(system, velocities)
    before = energy(chain, state)
    slide(system, state, step, n_steps)
    with np.errstate(over="ignore", invalid="ignore"):
        return energy(chain, state) / before


def energy_grows(chain: Chain, slide: Slide, step: float) -> bool:
    """Whether energy grows without limit at a step [s], whatever mode it is that grows."""
    velocities = np.sin(1.0 + 2.0 * np.arange(chain.n_blocks))
    return not energy_left(chain, slide, step, STEPS, velocities) < GROWTH


def bisect(
    fails: Callable[[float], bool], works: float, broken: float, bisections: int = BISECTIONS
) -> float:
    """Limit between a value that works and one that does not, on a logarithmic scale.

    Raises
    ------
    ValueError
        If the first does not work, or the second does.
    """
    if fails(works) or not fails(broken):
        raise ValueError(f"no limit to be found: {works!r} has to work and {broken!r} to fail")
    for _ in range(bisections):
        middle = math.sqrt(works * broken)
        works, broken = (works, middle) if fails(middle) else (middle, broken)
    return broken


def largest_stable_step(chain: Chain, slide: Slide, works: float = 1e-8, broken: float = 1e-4) -> float:
    """Step [s] above which the energy of a chain without friction grows, by bisection between two steps."""
    return bisect(partial(energy_grows, chain, slide), works, broken)


def rk4_growth(z: float) -> float:
    """Factor on the energy a step of RK4: |1 + iz - z^2/2 - iz^3/6 + z^4/24|^2."""
    return 1.0 - z**6 / 72.0 + z**8 / 576.0


def leapfrog_growth(z: float) -> float:
    """Factor on the energy a step of leapfrog in the long run: 1 up to its limit."""
    return math.exp(2.0 * math.acosh(max(0.5 * z * z - 1.0, 1.0)))


def moreau_jean_growth(z: float, theta: float) -> float:
    """Factor on the energy a step of Moreau-Jean time stepping: 1 at theta = 1/2, less above."""
    return (1.0 + ((1.0 - theta) * z) ** 2) / (1.0 + (theta * z) ** 2)
