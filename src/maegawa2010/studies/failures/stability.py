"""From which step each method fails: predicted and measured, for chains of 1 to 50
blocks.

While nothing switches, the energy of the fastest mode grows without bound beyond the
limit of a method; a dissipative one changes it at any step.
With friction, a block that starts from rest turns back within a step beyond the limit
and is stopped at its end: from stop to stop its distance from the middle is multiplied
by Re R(omega dt), where a step multiplies an oscillation by R. So a slip ends, although
the step is unstable, up to where this factor exceeds 1 in size.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import partial

import numpy as np
from scipy.optimize import brentq

from maegawa2010.methods import METHODS, SMOOTH, DivergedError
from maegawa2010.methods.attempt import attempt
from maegawa2010.methods.stability import (
    bisect,
    energy_left,
    highest_frequency,
    highest_mode,
    largest_stable_step,
    without_friction,
)
from maegawa2010.studies.failures.common import FIVE_SLIPS, Threshold
from precursors.benchmark.compare import transitions_right
from precursors.model.chain import Chain
from precursors.solver.run import Run
from precursors.solver.simulate import TransitionLimitError, simulate

SIZES = (1, 2, 10, 50)
# Keys of what fails. Without friction, energy grows without bound, or halves in five
# periods; with it, there is no global slip or numbers overflow, or a transition
# of the first five slips is wrong.
ENERGY_UNBOUNDED = "energy_unbounded"
ENERGY_CHANGED = "energy_changed"
NO_GLOBAL_SLIP = "no_global_slip"
SEQUENCE_WRONG = "sequence_wrong"

# Names of the formulas, omega being the chain's highest angular frequency.
RK4_THEORY = "2 sqrt 2 / omega"
TWO = "2 / omega"
GROWING = {"rk4_skip": RK4_THEORY, "leapfrog": TWO}
DISSIPATIVE = "moreau_jean_one"
DISSIPATION = "factor 1 / (1 + (omega dt)^2) a step"
# Limits of omega dt from stop to stop. Where a method locates its stops, or friction
# acts within a step, it is the limit without friction.
STOPPING = {
    "rk4_skip": (2.0 * math.sqrt(3.0), "2 sqrt 3 / omega"),
    "rk4_located": (2.0 * math.sqrt(2.0), RK4_THEORY),
    "karnopp": (2.0 * math.sqrt(2.0), RK4_THEORY),
    "leapfrog": (2.0, TWO),
}
INTERVAL = "shortest time between two transitions, read off the exact run"

# Five periods of the fastest mode [rad], and steps over which the change of its energy
# in one is an average.
PERIODS = 10.0 * math.pi
STEPS = 200
# With friction: parts of the limit, and where a run ends, in times to the first global
# slip and transitions.
PARTS = 0.8 * 1.02 ** np.arange(50)
LATER = 2.0
MOST = 20_000
# Methods with which the first five slips are run, besides RK4 with its transitions
# located, and their steps [s] from coarse to fine.
IN_STEPS = ("rk4_skip", "leapfrog", "moreau_jean_half", DISSIPATIVE, "karnopp")
COARSE_STEPS = 1e-5 * 10.0 ** -np.arange(0.0, 4.0, 0.25)


def thresholds() -> Iterator[Threshold]:
    """All but those of friction laws and of locating, which are measured with these
    failures."""
    for n_blocks in SIZES:
        chain = Chain.from_slider(n_blocks=n_blocks)
        yield from without(without_friction(chain))
        yield from with_friction(chain)
    yield from five_slips(simulate(Chain.from_slider(), FIVE_SLIPS))


def without(free: Chain) -> Iterator[Threshold]:
    """Steps [s] from which energy grows without bound or changes too much, in a chain
    without friction."""
    omega = highest_frequency(free)
    n = free.n_blocks
    for name, theory in GROWING.items():
        limit = SMOOTH[name].limit / omega
        found = largest_stable_step(free, SMOOTH[name].slide)
        yield Threshold(name, n, ENERGY_UNBOUNDED, theory, limit, found)
    yield Threshold(DISSIPATIVE, n, ENERGY_CHANGED, DISSIPATION, *changing_step(free))


def changing_step(free: Chain) -> tuple[float, float]:
    """Step [s] from which the energy of the fastest mode halves: predicted and
    measured."""
    method = SMOOTH[DISSIPATIVE]
    omega = highest_frequency(free)
    mode = highest_mode(free)

    def change(factor: float, z: float) -> float:
        return abs(math.log2(factor)) * PERIODS / z

    def changes(z: float) -> bool:
        left = energy_left(free, method.slide, z / omega, STEPS, mode)
        return change(left ** (1.0 / STEPS), z) > 1.0

    bounds = 1e-3, 2.0
    predicted = brentq(lambda z: change(method.energy_factor(z), z) - 1.0, *bounds)
    return predicted / omega, bisect(changes, *bounds) / omega


def with_friction(chain: Chain) -> Iterator[Threshold]:
    """Steps [s] from which a run from rest has no global slip, or its numbers
    overflow."""
    omega = highest_frequency(chain)
    end = LATER * simulate(chain, 10.0, "global slip").duration
    for name, (limit, theory) in STOPPING.items():
        if name == "rk4_located" and chain.n_blocks != 10:
            # Of few blocks one stops in nearly every step, and many blocks take
            # minutes.
            continue
        if name == "leapfrog" and chain.n_blocks == 1:
            # Block 1 turns back and forth where a stop lies beyond the limit of static
            # friction.
            limit = 2.0 * math.sqrt(chain.mu_s / (chain.mu_s - chain.mu_k))
            theory = "2 sqrt(mu_s / (mu_s - mu_k)) / omega"
        lost = partial(gets_lost, chain, name, end)
        found = next(filter(lost, PARTS * limit / omega), math.inf)
        yield Threshold(
            name, chain.n_blocks, NO_GLOBAL_SLIP, theory, limit / omega, found
        )


def gets_lost(chain: Chain, name: str, end: float, step: float) -> bool:
    """Whether a run has no global slip, or its numbers overflow, or it makes
    transitions without end."""
    try:
        found = METHODS[name].solve(
            chain, end, step, "global slip", max_transitions=MOST
        )
        return found.run.duration >= end
    except (DivergedError, TransitionLimitError):
        return True


def five_slips(exact: Run) -> Iterator[Threshold]:
    """Longest steps [s] with which all transitions of a run are the exact one's."""
    chain = exact.chain
    expected = dict.fromkeys(IN_STEPS, (INTERVAL, float(exact.intervals.min())))
    expected[DISSIPATIVE] = (DISSIPATION, changing_step(without_friction(chain))[0])
    limit, theory = STOPPING["rk4_located"]
    expected["rk4_located"] = (theory, limit / highest_frequency(chain))
    for name, (theory, predicted) in expected.items():
        found = next(filter(partial(is_right, exact, name), COARSE_STEPS), math.inf)
        yield Threshold(name, chain.n_blocks, SEQUENCE_WRONG, theory, predicted, found)


def is_right(exact: Run, name: str, value: float) -> bool:
    """Whether a method with a value of its setting has all transitions right."""
    run = attempt(METHODS[name].solve, exact.chain, exact.duration, value, None).run
    return transitions_right(run, exact) == len(exact.transitions)
