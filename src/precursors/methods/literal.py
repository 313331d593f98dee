"""Eq. 4 taken literally: friction is static where the velocity is exactly zero, and nowhere else.

That is Karnopp's method with a dead zone of no width. A velocity that crosses zero between two evaluations is
never exactly zero: a block that has once slid never sticks again, it trembles about zero by what a step
changes its velocity, and creeps in proportion. With the paper's drive the load then never exceeds mu_s w_1 at
steps from 1e-7 s on (theta <= 0); at finer ones it rises past it, without slips.
"""

from __future__ import annotations

from precursors.methods import karnopp
from precursors.methods.common import Method, Result
from precursors.model.chain import Chain

# Below, each run records more than ten million changes of sign.
STEPS = (3e-6, 1e-6, 3e-7)


def solve(chain: Chain, duration: float, step: float, until: str | None = None) -> Result:
    """Integrate Eqs. 2-6 as printed with the classical Runge-Kutta method.

    Raises
    ------
    ValueError, DivergedError, TransitionLimitError
        As `common.march`.
    """
    return karnopp.solve(chain, duration, step, until, dead_zone=0.0)


METHODS = (Method("literal", "Eq. 4 taken literally", "step [s]", STEPS, solve),)
