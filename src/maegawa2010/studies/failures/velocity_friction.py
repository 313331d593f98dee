"""Friction as a function of the velocity: Eq. 4 taken literally, and Karnopp's dead
zone, too narrow or too wide."""

from itertools import dropwhile, islice

import numpy as np

from maegawa2010.studies.failures import karnopp
from maegawa2010.studies.failures.common import Curve
from precursors.model.chain import Chain
from precursors.solver.simulate import simulate

END = 1.0  # s
LITERAL_STEPS = (3e-6, 1e-6)  # s
POINTS = 66
STEPS = (4e-8, 2e-8)  # s
# Widths too narrow, as parts of the safe width, and too wide [m/s].
NARROW_ZONES = np.geomspace(0.02, 0.5, 10)
WIDE_ZONES = np.geomspace(1e-5, 3e-2, 15)
# Block 1 should stick between these times after it has left the zone [s].
STICKS = (30e-6, 130e-6)


def literal_friction() -> list[Curve]:
    """With Eq. 4 as printed a block that has once slid never sticks again."""
    chain = Chain.from_slider()
    run = simulate(chain, END)
    exact_times = np.concatenate([[0.0], run.transitions["time"], [END]])
    exact = run.tangential_load(exact_times)
    curves = [Curve("exact", exact_times, exact, "exact")]
    limit = float(chain.strength[0])
    onset = limit / chain.loading_rate
    for step in LITERAL_STEPS:
        n_steps = round((END - onset) / POINTS / step)
        motion = islice(karnopp.from_limit(chain, 0.0, step, n_steps), POINTS)
        load = [0.0, limit, *(load for load, _ in motion)]
        times = onset + n_steps * step * np.arange(POINTS + 1)
        curves.append(Curve(f"dt = {step:.0e} s", [0.0, *times], load))
    return curves


def dead_zone_too_small() -> list[Curve]:
    """Karnopp's dead zone, so narrow that a block jumps across it and does not
    stick."""
    chain = Chain.from_slider()
    curves = []
    for step in STEPS:
        zones = NARROW_ZONES * karnopp.safe_width(chain, step)
        rests = [time_at_rest(chain, zone, step) for zone in zones]
        curves.append(Curve(f"dt = {step:.0e} s", NARROW_ZONES, rests))
    return curves


def time_at_rest(chain: Chain, dead_zone: float, step: float) -> float:
    """Share of the time in `STICKS` in which block 1 is in the dead zone."""
    velocities = (speed for _, speed in karnopp.from_limit(chain, dead_zone, step))
    slip = dropwhile(lambda velocity: velocity <= dead_zone, velocities)
    first, last = (round(time / step) for time in STICKS)
    return float(np.mean(abs(np.array([*islice(slip, first, last)])) <= dead_zone))


def dead_zone_too_large() -> list[Curve]:
    """Karnopp's dead zone, so wide that blocks creep in it beyond mu_s w."""
    chain = Chain.from_slider()
    delays = [karnopp.release_delay(chain, zone) for zone in WIDE_ZONES]
    theory = chain.loading_rate * np.array(delays)
    excess = [first_excess(chain, zone) for zone in WIDE_ZONES]
    return [
        Curve("theory", WIDE_ZONES, theory, "theory"),
        Curve("measured", WIDE_ZONES, excess),
    ]


def first_excess(chain: Chain, dead_zone: float) -> float:
    """F_X - mu_s w [N] when block 1 first leaves the dead zone."""
    motion = karnopp.from_limit(chain, dead_zone, STEPS[0])
    load = next(load for load, velocity in motion if velocity > dead_zone)
    return load - float(chain.strength[0])
