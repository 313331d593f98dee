"""Karnopp's dead zone: too narrow, blocks jump over it within a step; too wide, blocks
creep in it."""

from __future__ import annotations

from functools import partial

import numpy as np

from precursors.accuracy.compare import transitions_right
from precursors.accuracy.failures.common import (
    FIVE_SLIPS,
    Curve,
    Failure,
    Number,
)
from precursors.methods import karnopp
from precursors.model.chain import Chain
from precursors.solver.run import Run
from precursors.solver.simulate import simulate

STEPS = (4e-8, 2e-8)  # s
# Widths too small, as parts of the safe width, and too large [m/s].
SMALL_ZONES = np.geomspace(0.02, 0.5, 10)
LARGE_ZONES = np.geomspace(1e-5, 3e-2, 15)
TOO_SMALL = 0.05
TOO_LARGE = 2e-2


def right_with(exact: Run, step: float, dead_zone: float) -> int:
    """Transitions that Karnopp's method gets right with a step [s] and a dead zone
    [m/s]."""
    run = karnopp.solve(exact.chain, exact.duration, step, None, dead_zone).run
    return transitions_right(run, exact)


def first_excess(chain: Chain, dead_zone: float) -> float:
    """F_X - mu_s w [N] when block 1 of a uniform chain first leaves the dead zone."""
    limit = float(chain.strength.max())
    run = karnopp.solve(
        chain, 1.2 * limit / chain.loading_rate, STEPS[0], None, dead_zone
    ).run
    return float(run.transitions["tangential_load"][0]) - limit


def dead_zone_too_small() -> Failure:
    """Karnopp's dead zone, so narrow that blocks jump over it within a step."""
    exact = simulate(Chain.from_slider(), FIVE_SLIPS)
    lines = []
    numbers = []
    for step in STEPS:
        safe = karnopp.safe_width(exact.chain, step)
        setting = f"dt = {step:.0e} s"
        right = [right_with(exact, step, part * safe) for part in SMALL_ZONES]
        lines.append(Curve(setting, SMALL_ZONES, right))
        numbers.append(
            Number(
                method="Karnopp",
                setting=f"{setting}, zone = {TOO_SMALL:g} safe",
                quantity="transitions_right",
                unit="1",
                measured=right_with(exact, step, TOO_SMALL * safe),
                exact=len(exact.transitions),
            )
        )
    return Failure(
        tuple(numbers),
        x="zone_over_safe_width",
        y="transitions_right",
        curves=tuple(lines),
    )


def dead_zone_too_large() -> Failure:
    """Karnopp's dead zone, so wide that blocks creep in it beyond mu_s w."""
    exact = simulate(Chain.from_slider(), FIVE_SLIPS)
    chain = exact.chain
    step = STEPS[0]
    measured = [first_excess(chain, zone) for zone in LARGE_ZONES]
    theory = [predicted_excess(chain, zone) for zone in LARGE_ZONES]
    wide = partial(Number, "Karnopp", f"zone = {TOO_LARGE:g} m/s")
    excess = wide(
        "excess_at_release",
        "N",
        measured=first_excess(chain, TOO_LARGE),
        exact=0.0,
        predicted=predicted_excess(chain, TOO_LARGE),
    )
    right = wide(
        "transitions_right",
        "1",
        measured=right_with(exact, step, TOO_LARGE),
        exact=len(exact.transitions),
    )
    return Failure(
        (excess, right),
        x="zone_m_per_s",
        y="excess_N",
        curves=(
            Curve("theory", LARGE_ZONES, theory, "theory"),
            Curve("measured", LARGE_ZONES, measured),
        ),
    )


def predicted_excess(chain: Chain, dead_zone: float) -> float:
    """`first_excess` by the closed form of the creep in a dead zone [N]."""
    return chain.loading_rate * karnopp.release_delay(chain, dead_zone)
