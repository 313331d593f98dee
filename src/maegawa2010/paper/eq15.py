"""Check Eq. 15, mu_sapp <= mu_s, in symbols, over all states of rest, and in motion.

Eq. 15 holds for a chain at rest. In motion inertia can violate it: `fast_drive` finds the
drive velocity from which it does. `below_limit` measures how far a run stays from the
state of Eq. 12, in which F_X = mu_s F_Z.
"""

import math
from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
import pandas as pd
import scipy

from precursors.analysis.load_curve import load_curve
from precursors.analysis.slips import slip_table
from precursors.analysis.summary import apparent_friction
from precursors.model.chain import Chain, FloatArray
from precursors.model.statics import (
    compressions_as_printed,
    largest_load_at_rest,
    load_bound,
    maximal_compressions,
    maximal_strain_positions,
)
from precursors.solver.run import Run
from precursors.solver.simulate import simulate

SYMBOLIC_BLOCKS = 10
# A start with slightly less than the maximal strain has this fraction of it.
SLIGHTLY_BELOW = 0.999
# Relative tolerance of the drive velocity at which F_X exceeds mu_s F_Z. The formula is
# that of a rigid slider, but the chain is elastic and moves before F_X = mu_k F_Z.
RIGID_TOLERANCE = 0.25
# Decimals of that velocity and of the distance from the limit: few enough that rounding
# errors of 10 s do not show.
DIGITS = 4
# A run lasts this many times as long as F_X of a resting chain needs to reach mu_s F_Z.
ADVANCES = 3
# Relative tolerances. HiGHS is asked for 1e-10 of F_Z; sums of N terms are rounded to
# 1e-16 each.
LP_TOLERANCE = 1e-9
ROUNDING = 1e-12

STATEMENTS = {
    "at_limit": "F_X = mu_s F_Z with all blocks at their limit",
    "as_printed": "Eq. 12 as printed gives mu_s F_Z + (k/K - 1) mu_s w_N",
    "at_rest": "largest F_X of all states of rest is mu_s F_Z",
    "full_strain": "mu_sapp = mu_s, pushed from maximal residual strain",
    "less_strain": "mu_sapp < mu_s, pushed from "
    f"{SLIGHTLY_BELOW:g} of maximal residual strain",
    "rigid": "mu_sapp = mu_s for a rigid slider, N = 1",
    "fast": "in motion F_X exceeds mu_s F_Z if V exceeds (mu_s - mu_k) F_Z / sqrt(K M),"
    f" to {100 * RIGID_TOLERANCE:g} %",
    "below": "at each slip onset a block is below its limit (least share, above 0)",
}


class Check(NamedTuple):
    """A check: its key in STATEMENTS, the expected value, and ours (`computed`).

    The case is a scene or a number of blocks.
    """

    check: str
    case: str
    unit: str
    expected: Any
    computed: Any
    holds: bool


def close(
    check: str,
    case: str,
    unit: str,
    expected: float,
    value: float,
    tolerance: float = ROUNDING,
) -> Check:
    """Check that our value is the expected one to a relative tolerance."""
    holds = math.isclose(value, expected, rel_tol=tolerance)
    return Check(check, case, unit, expected, value, holds)


def eq15_table(runs: Mapping[str, Run], duration: float) -> pd.DataFrame:
    """One row per `Check` on the runs of the scenes; runs to the first global slip end
    after `duration` [s] at the latest."""
    rows = [*in_symbols(SYMBOLIC_BLOCKS)]
    for make in (as_printed, at_rest):
        rows += [make(scene, run.chain) for scene, run in runs.items()]
    for scene, run in runs.items():
        rows += in_motion(scene, run.chain, duration)
    for scene, run in runs.items():
        rows += [fast_drive(scene, run.chain), below_limit(scene, run)]
    first = next(iter(runs.values()))
    table = pd.DataFrame([*rows, rigid(first.chain, duration)])
    return table.assign(statement=table["check"].map(STATEMENTS))


def in_symbols(n: int) -> Iterator[Check]:
    """Check the load F_X = K y_1 of Eq. 12 for N blocks with any normal loads: as it
    follows from Eqs. 2, 3 and 11, and as printed, with K y_N in the last line.

    Every block rests at its limit mu_s w_i. The spring behind it pushes it forward with
    K y_1 or k y_i, and the spring ahead, which block N does not have, pushes it back.
    """
    import sympy  # slow

    K, k, mu_s = sympy.symbols("K k mu_s")
    # w_01 and not w_1, because SymPy sorts terms by name.
    w = sympy.symbols([f"w_{i:02d}" for i in range(1, n + 1)])
    y = sympy.symbols(f"y_1:{n + 1}")
    behind = [K * y[0], *(k * compression for compression in y[1:])]
    ahead = [*behind[1:], 0]
    limits = [mu_s * load for load in w]
    balances = [b - a - f for b, a, f in zip(behind, ahead, limits, strict=True)]
    printed = [*balances[:-1], K * y[-1] - limits[-1]]
    bound = sum(limits)
    excess = (k / K - 1) * limits[-1]
    for check, equations, expected in (
        ("at_limit", balances, bound),
        ("as_printed", printed, bound + excess),
    ):
        (solution,) = sympy.linsolve(equations, y)
        load = sympy.expand(K * solution[0])
        wanted = sympy.expand(expected)
        yield Check(
            check, f"N = {n}, in symbols", "N", str(wanted), str(load), load == wanted
        )


def as_printed(scene: str, chain: Chain) -> Check:
    """Check the load of Eq. 12 as printed: its N equations, solved in numbers, against
    the formula."""
    stiffer = chain.stiffness / chain.drive_stiffness - 1
    expected = load_bound(chain) + stiffer * float(chain.strength[-1])
    load = float(chain.drive_stiffness * compressions_as_printed(chain)[0])
    return close("as_printed", scene, "N", expected, load)


def at_rest(case: str, chain: Chain) -> Check:
    """Check that the largest load over all states of rest is mu_s F_Z, and that it is
    reached in the state of Eq. 12 (corrected)."""
    expected = load_bound(chain)
    load, compressions = largest_load_at_rest(chain)
    holds = math.isclose(load, expected, rel_tol=LP_TOLERANCE) and np.allclose(
        compressions, maximal_compressions(chain), rtol=LP_TOLERANCE, atol=0
    )
    return Check("at_rest", case, "N", expected, load, holds)


def in_motion(scene: str, chain: Chain, duration: float) -> Iterator[Check]:
    """Check mu_sapp of a chain pushed from the state of maximal residual strain, and
    from slightly below it.

    At a fraction a of that strain the net force on every block is a mu_s w_i. Block 1
    slips first, at F_X = a mu_s F_Z + (1 - a) mu_s w_1, and the others are close enough
    to their limits to follow it.
    """
    full = maximal_strain_positions(chain)
    share = float(chain.weights[0]) / chain.normal_load
    for check, a in (("full_strain", 1.0), ("less_strain", SLIGHTLY_BELOW)):
        expected = chain.mu_s * (a + (1 - a) * share)
        friction = pushed(chain, a * full, duration)
        yield close(check, scene, "1", expected, friction)


def largest_load(chain: Chain, speed: float) -> float:
    """Largest F_X [N] of a chain driven at `speed` [m/s], from natural length to the end
    of its first global slip.

    A chain that is driven fast never stops. Its run includes one swing of the whole
    slider on the drive's spring.
    """
    driven = replace(chain, drive_velocity=speed)
    swing = math.tau * math.sqrt(chain.n_blocks * chain.mass / chain.drive_stiffness)
    duration = ADVANCES * load_bound(chain) / driven.loading_rate + swing
    return float(load_curve(simulate(driven, duration, "global slip"))[1].max())


def fast_drive(scene: str, chain: Chain) -> Check:
    """Compare the drive velocity from which F_X exceeds mu_s F_Z with that of a rigid
    slider; NaN if there is none.

    A rigid slider at rest that is loaded with mu_k F_Z when the drive starts with V
    reaches at most F_X = mu_k F_Z + V sqrt(K M). The search ends at the velocity at
    which V sqrt(K M) alone is mu_s F_Z.
    """
    momentum = math.sqrt(chain.drive_stiffness * chain.n_blocks * chain.mass)
    expected = (chain.mu_s - chain.mu_k) * chain.normal_load / momentum

    def excess(speed: float) -> float:
        return largest_load(chain, speed) - load_bound(chain)

    between = chain.drive_velocity, load_bound(chain) / momentum
    passes = excess(between[0]) <= 0.0 < excess(between[1])
    velocity = (
        round(scipy.optimize.brentq(excess, *between, xtol=1e-6), DIGITS)
        if passes
        else math.nan
    )
    return close("fast", scene, "m/s", expected, velocity, RIGID_TOLERANCE)


def below_limit(scene: str, run: Run) -> Check:
    """Check that a run stays away from the state of Eq. 12, in which all blocks are at
    their limits at the same time.

    At the onset of each slip we take the block that is farthest below its limit mu_s w_i.
    The value is the smallest of these distances over all slips, over mu_s w_i.
    """
    forces = run.spring_forces(slip_table(run)["onset_s"])
    below = 1.0 + np.diff(forces, append=0.0) / run.chain.strength
    least = round(float(below.max(axis=1).min(initial=math.inf)), DIGITS)
    return Check("below", scene, "1", 0.0, least, least > 0.0)


def rigid(chain: Chain, duration: float) -> Check:
    """Check mu_sapp of one block with the weight and the mass of the whole chain, pushed
    from natural length."""
    block = replace(
        chain, weights=np.array([chain.normal_load]), mass=chain.n_blocks * chain.mass
    )
    friction = pushed(block, None, duration)
    return close("rigid", "N = 1", "1", chain.mu_s, friction)


def pushed(chain: Chain, start: FloatArray | None, duration: float) -> float:
    """mu_sapp (Eq. 1) of a chain pushed from rest at given positions [m], by default
    natural length; NaN without a global slip."""
    run = simulate(chain, duration, "global slip", start_positions=start)
    return apparent_friction(run)
