"""Karnopp's dead zone: too narrow, blocks jump over it within a step; too wide, blocks
creep in it."""

from __future__ import annotations

import numpy as np

from maegawa2010.methods import karnopp
from maegawa2010.studies.failures.common import FIVE_SLIPS, Curve, Failure
from precursors.benchmark.compare import transitions_right
from precursors.model.chain import Chain
from precursors.solver.simulate import simulate

STEPS = (4e-8, 2e-8)  # s
# Widths too small, as parts of the safe width, and too large [m/s].
SMALL_ZONES = np.geomspace(0.02, 0.5, 10)
LARGE_ZONES = np.geomspace(1e-5, 3e-2, 15)


def dead_zone_too_small() -> Failure:
    """Karnopp's dead zone, so narrow that blocks jump over it within a step."""
    exact = simulate(Chain.from_slider(), FIVE_SLIPS)
    curves = []
    for step in STEPS:
        zones = SMALL_ZONES * karnopp.safe_width(exact.chain, step)
        runs = [
            karnopp.solve(exact.chain, FIVE_SLIPS, step, None, zone).run
            for zone in zones
        ]
        right = [transitions_right(run, exact) for run in runs]
        curves.append(Curve(f"dt = {step:.0e} s", SMALL_ZONES, right))
    return Failure("zone_over_safe_width", "transitions_right", curves)


def dead_zone_too_large() -> Failure:
    """Karnopp's dead zone, so wide that blocks creep in it beyond mu_s w."""
    chain = Chain.from_slider()
    measured = [first_excess(chain, zone) for zone in LARGE_ZONES]
    delays = [karnopp.release_delay(chain, zone) for zone in LARGE_ZONES]
    theory = chain.loading_rate * np.array(delays)
    curves = [
        Curve("theory", LARGE_ZONES, theory, "theory"),
        Curve("measured", LARGE_ZONES, measured),
    ]
    return Failure("zone_m_per_s", "excess_N", curves)


def first_excess(chain: Chain, dead_zone: float) -> float:
    """F_X - mu_s w [N] when block 1 of a uniform chain first leaves the dead zone."""
    limit = float(chain.strength.max())
    run = karnopp.solve(
        chain, 1.2 * limit / chain.loading_rate, STEPS[0], None, dead_zone
    ).run
    return float(run.transitions["tangential_load"][0]) - limit
