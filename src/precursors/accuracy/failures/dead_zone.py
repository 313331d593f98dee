"""Karnopp's dead zone: too narrow, blocks jump over it within a step; too wide, blocks creep in it."""

from __future__ import annotations

from functools import partial

import numpy as np

from precursors.accuracy.failures.common import Failure, Number, curves, transitions_right
from precursors.methods import karnopp
from precursors.methods.stability import bisect
from precursors.model.chain import Chain
from precursors.solver.run import Run
from precursors.solver.simulate import simulate

# The first five slips of theta = 0, with 30 transitions [s].
FIVE_SLIPS = 1.25
STEPS = (4e-8, 2e-8)  # s
# Widths too small, as parts of the safe width, and widths too large [m/s].
SMALL_ZONES = np.geomspace(0.02, 0.5, 10)
LARGE_ZONES = np.geomspace(1e-5, 3e-2, 15)
TOO_SMALL, TOO_LARGE = 0.05, 2e-2
JUMP_BISECTIONS = 7


def right_with(exact: Run, step: float, dead_zone: float) -> int:
    """Transitions that Karnopp's method gets right with a step [s] and a dead zone [m/s]."""
    run = karnopp.solve(exact.chain, exact.duration, step, None, dead_zone).run
    return transitions_right(run, exact)


def fails(exact: Run, step: float, dead_zone: float) -> bool:
    """Whether it gets any of them wrong."""
    return right_with(exact, step, dead_zone) < len(exact.transitions)


def smallest_dead_zone(exact: Run, step: float) -> float:
    """Width, as a part of the safe one, below which blocks jump over the zone; by bisection."""
    safe = karnopp.safe_width(exact.chain, step)
    return bisect(partial(fails, exact, step), 0.3 * safe, TOO_SMALL * safe, JUMP_BISECTIONS) / safe


def largest_dead_zone(exact: Run, step: float) -> float:
    """Width [m/s] above which creep in the zone changes the transitions; by bisection."""
    return bisect(partial(fails, exact, step), 5e-4, 5e-2)


def first_excess(chain: Chain, dead_zone: float) -> float:
    """What F_X exceeds mu_s w_1 by when block 1 first leaves the dead zone [N]."""
    end = 1.2 * chain.strength[0] / chain.loading_rate
    run = karnopp.solve(chain, end, STEPS[0], None, dead_zone).run
    return float(run.transitions["tangential_load"][0] - chain.strength[0])


def dead_zone_too_small() -> Failure:
    """Karnopp's dead zone, so narrow that blocks jump over it within a step."""
    exact = simulate(Chain.from_slider(), FIVE_SLIPS)
    n = len(exact.transitions)
    lines, numbers = {}, []
    for step in STEPS:
        safe, setting = karnopp.safe_width(exact.chain, step), f"dt = {step:.0e} s"
        lines[setting] = (SMALL_ZONES, [right_with(exact, step, part * safe) for part in SMALL_ZONES])
        few = right_with(exact, step, TOO_SMALL * safe)
        narrow = f"{setting}, zone = {TOO_SMALL:g} safe"
        numbers.append(Number("Karnopp", narrow, "transitions right", "1", few, n))
    limit, setting = smallest_dead_zone(exact, STEPS[0]), f"dt = {STEPS[0]:.0e} s"
    numbers.append(Number("Karnopp", setting, "zone from which all is right", "safe width", limit))
    return Failure(tuple(numbers), curves("zone_over_safe_width", "transitions_right", **lines))


def dead_zone_too_large() -> Failure:
    """Karnopp's dead zone, so wide that blocks creep in it beyond mu_s w."""
    exact = simulate(Chain.from_slider(), FIVE_SLIPS)
    chain, step = exact.chain, STEPS[0]
    excess = [first_excess(chain, zone) for zone in LARGE_ZONES]
    theory = [chain.loading_rate * karnopp.release_delay(chain, zone) for zone in LARGE_ZONES]
    wide = partial(Number, "Karnopp", f"zone = {TOO_LARGE:g} m/s")
    right = right_with(exact, step, TOO_LARGE)
    limit = largest_dead_zone(exact, step)
    return Failure(
        (
            wide("F_X above mu_s w_1 at release", "N", first_excess(chain, TOO_LARGE), 0.0),
            wide("transitions right", "1", right, len(exact.transitions)),
            Number("Karnopp", f"dt = {step:.0e} s", "zone up to which all is right", "m/s", limit),
        ),
        curves("zone_m_per_s", "excess_N", theory=(LARGE_ZONES, theory), measured=(LARGE_ZONES, excess)),
    )
