"""Laws of friction that stand in for Coulomb's: Eq. 4 as printed, a dead zone, a regularised jump."""

from __future__ import annotations

from functools import partial

import numpy as np
from numpy.typing import ArrayLike
from scipy.integrate import solve_ivp

from precursors.accuracy.failures.common import Failure, Number, curves, transitions_right
from precursors.methods import karnopp
from precursors.methods.events import time_unit
from precursors.methods.forces import at_rest, system_of
from precursors.methods.regularised import creep_velocity, equations
from precursors.methods.stability import RK4_LIMIT, bisect, highest_frequency
from precursors.model.chain import Chain, FloatArray
from precursors.solver.run import Run
from precursors.solver.simulate import simulate

# The first five slips of theta = 0, with 30 transitions [s].
FIVE_SLIPS = 1.25
# Eq. 4 as printed: until when [s] and with which steps [s].
LITERAL_END = 1.0
LITERAL_STEPS = (3e-6, 1e-6)
# Dead zones: steps [s]; widths too small, as parts of the safe width; widths too large [m/s].
ZONE_STEPS = (4e-8, 2e-8)
SMALL_ZONES = np.geomspace(0.02, 0.5, 10)
LARGE_ZONES = np.geomspace(1e-5, 3e-2, 15)
TOO_SMALL, TOO_LARGE = 0.05, 2e-2
JUMP_BISECTIONS = 7
# Regularised friction: widths [m/s] and loads, as parts of mu_s w.
WIDTHS = (1e-5, 1e-6, 1e-7)
LOADS = np.array([0.3, 0.6, 0.9])
STIFF_WIDTHS = np.geomspace(1e-9, 1e-4, 11)
CHARTED_WIDTH, CHARTED_LOAD = 1e-6, 2
# A stiff decay is stable with RK4 up to this lambda dt.
RK4_REAL_LIMIT = 2.785293563


def literal_load(chain: Chain, step: float, times: FloatArray) -> FloatArray:
    """F_X [N] with Eq. 4 as printed, at some times [s] after block 1 has first reached its limit."""
    system = system_of(chain)
    state = at_rest(system)
    state.tension[1] = chain.strength[0]
    load = []
    for time in np.diff(times, prepend=0.0):
        karnopp.slide(system, state, step, round(time / step), 0.0)
        load.append(float(state.tension[1]))
    return np.array(load)


def literal_friction() -> Failure:
    """Eq. 4 taken literally: friction is static only where the velocity is exactly zero."""
    chain = Chain.from_slider()
    run = simulate(chain, LITERAL_END)
    exact_times = np.concatenate([[0.0], run.transitions["time"], [LITERAL_END]])
    exact = run.tangential_load(exact_times)
    onset = chain.strength[0] / chain.loading_rate
    times = np.linspace(0.0, LITERAL_END - onset, 66)
    lines = {"exact": (exact_times, exact)}
    numbers = []
    for step in LITERAL_STEPS:
        load = literal_load(chain, step, times)
        lines[f"dt = {step:.0e} s"] = (np.append(0.0, onset + times), np.append(0.0, load))
        numbers.append(
            Number(
                "RK4 with Eq. 4 as printed", f"dt = {step:.0e} s", "largest F_X in 1 s", "N",
                float(load.max()), float(exact.max()),
            )
        )  # fmt: skip
    return Failure(tuple(numbers), curves("time_s", "tangential_load_N", **lines))


def dead_zone_right(exact: Run, step: float, dead_zone: float) -> int:
    """Transitions that Karnopp's method gets right with a step [s] and a dead zone [m/s]."""
    run = karnopp.solve(exact.chain, exact.duration, step, None, dead_zone).run
    return transitions_right(run, exact)


def dead_zone_fails(exact: Run, step: float, dead_zone: float) -> bool:
    """Whether it gets any of them wrong."""
    return dead_zone_right(exact, step, dead_zone) < len(exact.transitions)


def smallest_dead_zone(exact: Run, step: float) -> float:
    """Width, as a part of the safe one, below which blocks jump over the zone; by bisection."""
    safe = karnopp.safe_width(exact.chain, step)
    fails = partial(dead_zone_fails, exact, step)
    return bisect(fails, 0.3 * safe, TOO_SMALL * safe, JUMP_BISECTIONS) / safe


def largest_dead_zone(exact: Run, step: float) -> float:
    """Width [m/s] above which creep in the zone changes the transitions; by bisection."""
    return bisect(partial(dead_zone_fails, exact, step), 5e-4, 5e-2)


def dead_zone_too_small() -> Failure:
    """Karnopp's dead zone, so narrow that blocks jump over it within a step."""
    exact = simulate(Chain.from_slider(), FIVE_SLIPS)
    n = len(exact.transitions)
    lines, numbers = {}, []
    for step in ZONE_STEPS:
        safe = karnopp.safe_width(exact.chain, step)
        right = [dead_zone_right(exact, step, part * safe) for part in SMALL_ZONES]
        lines[f"dt = {step:.0e} s"] = (SMALL_ZONES, right)
        knob = f"dt = {step:.0e} s"
        few = dead_zone_right(exact, step, TOO_SMALL * safe)
        numbers.append(
            Number("Karnopp", f"{knob}, zone = {TOO_SMALL:g} safe", "transitions right", "1", few, n)
        )
    limit = smallest_dead_zone(exact, ZONE_STEPS[0])
    knob = f"dt = {ZONE_STEPS[0]:.0e} s"
    numbers.append(Number("Karnopp", knob, "zone from which all is right", "safe width", limit))
    return Failure(tuple(numbers), curves("zone_over_safe_width", "transitions_right", **lines))


def first_excess(chain: Chain, dead_zone: float) -> float:
    """What F_X exceeds mu_s w_1 by when block 1 first leaves the dead zone [N]."""
    end = 1.2 * chain.strength[0] / chain.loading_rate
    run = karnopp.solve(chain, end, ZONE_STEPS[0], None, dead_zone).run
    return float(run.transitions["tangential_load"][0] - chain.strength[0])


def dead_zone_too_large() -> Failure:
    """Karnopp's dead zone, so wide that blocks creep in it beyond mu_s w."""
    exact = simulate(Chain.from_slider(), FIVE_SLIPS)
    chain, step = exact.chain, ZONE_STEPS[0]
    excess = [first_excess(chain, zone) for zone in LARGE_ZONES]
    theory = [chain.loading_rate * karnopp.release_delay(chain, zone) for zone in LARGE_ZONES]
    return Failure(
        (
            Number(
                "Karnopp", f"zone = {TOO_LARGE:g} m/s", "F_X above mu_s w_1 at release", "N",
                first_excess(chain, TOO_LARGE), 0.0,
            ),
            Number(
                "Karnopp", f"zone = {TOO_LARGE:g} m/s", "transitions right", "1",
                dead_zone_right(exact, step, TOO_LARGE), len(exact.transitions),
            ),
            Number(
                "Karnopp", f"dt = {step:.0e} s", "zone up to which all is right", "m/s",
                largest_dead_zone(exact, step),
            ),
        ),
        curves("zone_m_per_s", "excess_N", theory=(LARGE_ZONES, theory), measured=(LARGE_ZONES, excess)),
    )  # fmt: skip


def measured_creep(ratio: float, width: float) -> float:
    """Velocity [m/s] of a block under the load ratio * mu_s w that regularised friction should hold."""
    # So soft a drive keeps the load constant.
    chain = Chain.from_slider(n_blocks=1, drive_stiffness=1e-3, drive_velocity=1e-12)
    load = ratio * float(chain.strength[0])
    right_hand_side, matrix = equations(chain, width)
    solution = solve_ivp(
        right_hand_side, (0.0, 1.0), [load, 0.0], "Radau", jac=matrix, rtol=1e-8, atol=[1e-8, 1e-18]
    )
    return float(solution.y[1, -1]) * time_unit(chain) / chain.mass


def creep() -> Failure:
    """Regularised friction: a block under less than mu_s w creeps."""
    block = Chain.from_slider(n_blocks=1)
    weight, strength = float(block.weights[0]), float(block.strength[0])
    fine = np.linspace(0.02, 0.99, 98)
    lines: dict[str, tuple[ArrayLike, ArrayLike]] = {
        "the_drive": (fine[[0, -1]], 2 * (block.drive_velocity,))
    }
    for width in WIDTHS:
        theory = [creep_velocity(ratio * strength, weight, width, block.mu_s) for ratio in fine]
        lines[f"theory, width = {width:.0e} m/s"] = (fine, theory)
        lines[f"width = {width:.0e} m/s"] = (LOADS, [measured_creep(ratio, width) for ratio in LOADS])
    ratio = LOADS[CHARTED_LOAD]
    speed = measured_creep(ratio, CHARTED_WIDTH)
    knob = f"width = {CHARTED_WIDTH:.0e} m/s, F = {ratio:g} mu_s w"
    return Failure(
        (
            Number("regularised friction", knob, "velocity in stick", "m/s", speed, 0.0),
            Number(
                "regularised friction", knob, "velocity in stick, of the drive's", "1",
                speed / block.drive_velocity, 0.0,
            ),
        ),
        curves("load_over_strength", "velocity_m_per_s", **lines),
    )  # fmt: skip


def fastest_rate(chain: Chain, width: float) -> float:
    """Largest eigenvalue of the equations with regularised friction at rest [1/s]."""
    _, matrix = equations(chain, width)
    rates = np.linalg.eigvals(matrix(0.0, np.zeros(2 * chain.n_blocks)))
    return float(np.abs(rates).max()) / time_unit(chain)


def stiffness() -> Failure:
    """Regularised friction: the narrower, the stiffer."""
    chain = Chain.from_slider()
    omega = highest_frequency(chain)
    rates = [fastest_rate(chain, width) for width in STIFF_WIDTHS]
    theory = [float(chain.strength.max()) / (chain.mass * width) for width in STIFF_WIDTHS]
    rate = fastest_rate(chain, CHARTED_WIDTH)
    knob = f"width = {CHARTED_WIDTH:.0e} m/s"
    method = "regularised friction"
    return Failure(
        (
            Number(method, knob, "fastest rate", "1/s", rate, omega),
            Number(method, knob, "longest stable step of RK4", "s", RK4_REAL_LIMIT / rate, RK4_LIMIT / omega),
        ),
        curves(
            "width_m_per_s",
            "fastest_rate_per_s",
            theory=(STIFF_WIDTHS, theory),
            measured=(STIFF_WIDTHS, rates),
            the_chain_itself=(STIFF_WIDTHS[[0, -1]], [omega, omega]),
        ),
    )
