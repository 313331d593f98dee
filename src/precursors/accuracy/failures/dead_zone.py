"""Karnopp's dead zone: too narrow, blocks jump over it within a step; too wide, blocks
creep in it."""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np

from precursors.accuracy.compare import transitions_right
from precursors.accuracy.failures import common
from precursors.accuracy.failures.common import (
    FIVE_SLIPS,
    Curve,
    Failure,
    Number,
    Threshold,
)
from precursors.accuracy.failures.stability import margin
from precursors.methods import ROWS, karnopp
from precursors.methods.stability import bisect
from precursors.model.chain import Chain, FloatArray
from precursors.solver.run import Run
from precursors.solver.simulate import simulate

STEPS = (4e-8, 2e-8)  # s
# Keys of what fails where the zone is too narrow and too wide; widths too small, as
# parts of the safe width, and widths too large [m/s].
ZONE_JUMPED_OVER = "zone_jumped_over"
CREEP_IN_ZONE = "creep_in_zone"
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
    """`smallest_dead_zone` by theory: the width that no stop of the exact run jumps over."""
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
    limit = _threshold(
        exact.chain,
        fails=ZONE_JUMPED_OVER,
        unit="safe width",
        theory="widest zone that a stop jumps over",
        predicted=predicted_dead_zone(exact),
        measured=smallest_dead_zone(exact, STEPS[0]),
    )
    return Failure(
        tuple(numbers),
        x="zone_over_safe_width",
        y="transitions_right",
        curves=tuple(lines),
        thresholds=(limit,),
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
    # Creep raises the load at which block 1 is released, as a greater mu_s does.
    delay = margin(exact) * chain.strength.max() / chain.loading_rate
    limit = _threshold(
        chain,
        fails=CREEP_IN_ZONE,
        unit="m/s",
        theory="creep raises a load by the margin",
        predicted=float(chain.loading_rate * delay**2 / (2.0 * chain.mass)),
        measured=largest_dead_zone(exact, step),
    )
    return Failure(
        (excess, right),
        x="zone_m_per_s",
        y="excess_N",
        curves=(
            Curve("theory", LARGE_ZONES, theory, "theory"),
            Curve("measured", LARGE_ZONES, measured),
        ),
        thresholds=(limit,),
    )


def predicted_excess(chain: Chain, dead_zone: float) -> float:
    """`first_excess` by the closed form of the creep in a dead zone [N]."""
    return chain.loading_rate * karnopp.release_delay(chain, dead_zone)


def _threshold(chain: Chain, **values: Any) -> Threshold:
    return Threshold("karnopp", ROWS["karnopp"]["label"], chain.n_blocks, **values)
