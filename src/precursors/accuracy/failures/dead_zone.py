"""Karnopp's dead zone: too narrow, blocks jump over it within a step; too wide, blocks
creep in it."""

from __future__ import annotations

from functools import partial

import numpy as np

from precursors.accuracy.compare import transitions_right
from precursors.accuracy.failures import common
from precursors.accuracy.failures.common import (
    FIVE_SLIPS,
    Failure,
    Number,
    Threshold,
    curves,
)
from precursors.accuracy.failures.stability import margin
from precursors.methods import METHODS, karnopp
from precursors.methods.stability import bisect
from precursors.model.chain import Chain, FloatArray
from precursors.solver.run import Run
from precursors.solver.simulate import simulate

LABEL = METHODS["karnopp"].label
STEPS = (4e-8, 2e-8)  # s
# What fails, widths too small, as parts of the safe width, and widths too large [m/s].
TOO_NARROW = "a narrower zone is jumped over"
TOO_WIDE = "creep in a wider zone changes transitions"
SMALL_ZONES = np.geomspace(0.02, 0.5, 10)
LARGE_ZONES = np.geomspace(1e-5, 3e-2, 15)
TOO_SMALL = 0.05
TOO_LARGE = 2e-2
JUMP_BISECTIONS = 7
# Of `jumped_over`: parts of a step's change of velocity by which a block can be above
# the zone, widths of the zone in the same unit, and steps after which a block that is
# still outside stays there.
STARTS = (np.arange(100) + 0.5) / 100
ZONES = np.linspace(0.0, 1.0, 501)[1:]
TREMBLING = 60


def right_with(exact: Run, step: float, dead_zone: float) -> int:
    """Transitions that Karnopp's method gets right with a step [s] and a dead zone
    [m/s]."""
    run = karnopp.solve(exact.chain, exact.duration, step, None, dead_zone).run
    return transitions_right(run, exact)


def fails(exact: Run, step: float, dead_zone: float) -> bool:
    """Whether it gets any of them wrong."""
    return right_with(exact, step, dead_zone) < len(exact.transitions)


def smallest_dead_zone(exact: Run, step: float) -> float:
    """Width, as a part of the safe one, below which blocks jump over the zone; by
    bisection."""
    safe = karnopp.safe_width(exact.chain, step)
    return (
        bisect(
            partial(fails, exact, step), 0.3 * safe, TOO_SMALL * safe, JUMP_BISECTIONS
        )
        / safe
    )


def jumped_over(turn: float) -> float:
    """Largest zone that a stopping block can jump over, with RK4's four evaluations in
    a step.

    In units of what a step takes from the velocity; beyond the zone, where friction has
    turned round, a step gives back `turn` of these. So the block may tremble about the
    zone without end.
    """
    zone = np.repeat(ZONES, len(STARTS))
    v = zone + np.tile(STARTS, len(ZONES))

    def rate(velocity: FloatArray) -> FloatArray:
        beyond = np.where(velocity < -zone, turn, 0.0)
        return np.where(velocity > zone, -1.0, beyond)

    for _ in range(TREMBLING):
        outside = abs(v) > zone
        zone = zone[outside]
        v = v[outside]
        v = common.runge_kutta_step(rate, v, 1.0)
    return float(zone.max(initial=0.0))


def predicted_dead_zone(exact: Run) -> float:
    """What `smallest_dead_zone` should be: the width that no stop of the exact run
    jumps over."""
    chain = exact.chain
    stops = exact.transitions[exact.transitions["mode"] == 0]
    forces = np.pad(exact.spring_forces(stops["time"]), ((0, 0), (0, 1)))
    block = stops["block"] - 1
    net = (forces[:, :-1] - forces[:, 1:])[np.arange(len(stops)), block]
    down = chain.kinetic_friction[block] - net
    up = chain.kinetic_friction[block] + net
    widths = [jumped_over(float(turn)) for turn in up / down] * down
    return (
        2.0
        * float(widths.max())
        / float((chain.strength + chain.kinetic_friction).max())
    )


def largest_dead_zone(exact: Run, step: float) -> float:
    """Width [m/s] above which creep in the zone changes the transitions; by
    bisection."""
    return bisect(partial(fails, exact, step), 5e-4, 5e-2)


def first_excess(chain: Chain, dead_zone: float) -> float:
    """What F_X exceeds mu_s w by when block 1 of a uniform chain first leaves the dead
    zone [N]."""
    limit = float(chain.strength.max())
    run = karnopp.solve(
        chain, 1.2 * limit / chain.loading_rate, STEPS[0], None, dead_zone
    ).run
    return float(run.transitions["tangential_load"][0]) - limit


def dead_zone_too_small() -> Failure:
    """Karnopp's dead zone, so narrow that blocks jump over it within a step."""
    exact = simulate(Chain.from_slider(), FIVE_SLIPS)
    n = len(exact.transitions)
    n_blocks = exact.chain.n_blocks
    lines = {}
    numbers = []
    for step in STEPS:
        safe = karnopp.safe_width(exact.chain, step)
        setting = f"dt = {step:.0e} s"
        lines[setting] = (
            SMALL_ZONES,
            [right_with(exact, step, part * safe) for part in SMALL_ZONES],
        )
        few = right_with(exact, step, TOO_SMALL * safe)
        narrow = f"{setting}, zone = {TOO_SMALL:g} safe"
        numbers.append(Number("Karnopp", narrow, "transitions right", "1", few, n))
    found = predicted_dead_zone(exact), smallest_dead_zone(exact, STEPS[0])
    limit = Threshold(
        LABEL,
        n_blocks,
        TOO_NARROW,
        "safe width",
        "widest zone that a stop jumps over",
        *found,
    )
    return Failure(
        tuple(numbers),
        curves("zone_over_safe_width", "transitions_right", **lines),
        (limit,),
    )


def dead_zone_too_large() -> Failure:
    """Karnopp's dead zone, so wide that blocks creep in it beyond mu_s w."""
    exact = simulate(Chain.from_slider(), FIVE_SLIPS)
    chain = exact.chain
    step = STEPS[0]
    excess = [first_excess(chain, zone) for zone in LARGE_ZONES]
    theory = [
        chain.loading_rate * karnopp.release_delay(chain, zone) for zone in LARGE_ZONES
    ]
    creep = chain.loading_rate * karnopp.release_delay(chain, TOO_LARGE)
    wide = partial(Number, "Karnopp", f"zone = {TOO_LARGE:g} m/s")
    right = right_with(exact, step, TOO_LARGE)
    # Creep raises the load at which block 1 is released, as a greater mu_s does.
    delay = margin(exact) * chain.strength.max() / chain.loading_rate
    found = (
        float(chain.loading_rate * delay**2 / (2.0 * chain.mass)),
        largest_dead_zone(exact, step),
    )
    limit = Threshold(
        LABEL,
        chain.n_blocks,
        TOO_WIDE,
        "m/s",
        "creep raises a load by the margin",
        *found,
    )
    return Failure(
        (
            wide(
                "F_X above mu_s w_1 at release",
                "N",
                first_excess(chain, TOO_LARGE),
                0.0,
                creep,
            ),
            wide("transitions right", "1", right, len(exact.transitions)),
        ),
        curves(
            "zone_m_per_s",
            "excess_N",
            theory=(LARGE_ZONES, theory),
            measured=(LARGE_ZONES, excess),
        ),
        (limit,),
    )
