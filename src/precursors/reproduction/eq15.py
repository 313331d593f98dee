"""Eq. 15, mu_sapp <= mu_s: checked in symbols, over all states of rest, and in motion."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import Any

import numpy as np
import pandas as pd
import sympy

from precursors.analysis.slip_rows import up_to_first_global
from precursors.analysis.slips import find_slips
from precursors.model.chain import Chain, FloatArray
from precursors.model.statics import (
    compressions_as_printed,
    largest_load_at_rest,
    load_bound,
    maximal_compressions,
    maximal_strain_positions,
)
from precursors.reproduction import derivation
from precursors.solver.simulate import simulate

SYMBOLIC_BLOCKS = 10
# A start slightly below the maximal strain, as a fraction of it.
SLIGHTLY_BELOW = 0.999
# Relative. HiGHS is asked for 1e-10 of F_Z; sums of N terms are rounded to 1e-16 each.
LP_TOLERANCE, ROUNDING = 1e-9, 1e-12

AT_LIMIT = "F_X = mu_s F_Z with all blocks at their limit"
AS_PRINTED = "Eq. 12 as printed gives mu_s F_Z + (k/K - 1) mu_s w_N"
AT_REST = "largest F_X of all states of rest is mu_s F_Z"
FULL_STRAIN = "mu_sapp = mu_s, pushed from maximal residual strain"
LESS_STRAIN = f"mu_sapp < mu_s, pushed from {SLIGHTLY_BELOW:g} of maximal residual strain"
RIGID = "mu_sapp = mu_s for a rigid slider, N = 1"


def eq15_table(scenes: Mapping[str, Chain], duration: float) -> pd.DataFrame:
    """Every check on a row: check, case, unit, expected, found, holds.

    Parameters
    ----------
    scenes : mapping of str to Chain
        Chains by the name of their scene.
    duration : float
        Time within which a global slip is awaited [s].
    """
    rows = [*in_symbols(SYMBOLIC_BLOCKS)]
    for check in (as_printed, at_rest):
        rows += [check(scene, chain) for scene, chain in scenes.items()]
    rows += [row for scene, chain in scenes.items() for row in in_motion(scene, chain, duration)]
    first = next(iter(scenes.values()))
    return pd.DataFrame([*rows, rigid(first, duration)])


def in_symbols(n: int) -> Iterator[dict[str, Any]]:
    """The load of Eq. 12 for N blocks with any normal loads, as it follows from Eq. 2 and as printed."""
    w, bound = derivation.weights(n), derivation.bound(n)
    excess = (derivation.k / derivation.K - 1) * derivation.mu_s * w[-1]
    for check, equations, expected in (
        (AT_LIMIT, derivation.balances(n), bound),
        (AS_PRINTED, derivation.balances_as_printed(n), bound + excess),
    ):
        found, wanted = derivation.load(equations), sympy.expand(expected)
        yield _row(check, f"N = {n}, in symbols", "N", str(wanted), str(found), found == wanted)


def as_printed(scene: str, chain: Chain) -> dict[str, Any]:
    """The load of Eq. 12 as printed, from its N equations in numbers and by the formula."""
    stiffer = chain.stiffness / chain.drive_stiffness - 1
    expected = load_bound(chain) + stiffer * float(chain.strength[-1])
    found = float(chain.drive_stiffness * compressions_as_printed(chain)[0])
    return _row(AS_PRINTED, scene, "N", expected, found, math.isclose(found, expected, rel_tol=ROUNDING))


def at_rest(case: str, chain: Chain) -> dict[str, Any]:
    """The largest load over all states of rest, which is reached in the state of Eq. 12 (corrected)."""
    expected = load_bound(chain)
    found, compressions = largest_load_at_rest(chain)
    holds = math.isclose(found, expected, rel_tol=LP_TOLERANCE) and np.allclose(
        compressions, maximal_compressions(chain), rtol=LP_TOLERANCE, atol=0
    )
    return _row(AT_REST, case, "N", expected, found, holds)


def in_motion(scene: str, chain: Chain, duration: float) -> Iterator[dict[str, Any]]:
    """mu_sapp of a chain pushed from the state of maximal residual strain, and from slightly below it.

    At a fraction a of that strain every block is at a mu_s w_i. Block 1 slips first, at
    F_X = a mu_s F_Z + (1 - a) mu_s w_1, and the others are near enough to their limits to follow it.
    """
    full = maximal_strain_positions(chain)
    share = float(chain.weights[0]) / chain.normal_load
    for check, a in ((FULL_STRAIN, 1.0), (LESS_STRAIN, SLIGHTLY_BELOW)):
        expected = chain.mu_s * (a + (1 - a) * share)
        found = apparent_friction(chain, a * full, duration)
        holds = math.isclose(found, expected, rel_tol=ROUNDING)
        yield _row(check, scene, "1", expected, found, holds)


def rigid(chain: Chain, duration: float) -> dict[str, Any]:
    """mu_sapp of one block with the weight and the mass of the whole chain, pushed from natural length."""
    block = replace(chain, weights=np.array([chain.normal_load]), mass=chain.n_blocks * chain.mass)
    found = apparent_friction(block, None, duration)
    return _row(RIGID, "N = 1", "1", chain.mu_s, found, math.isclose(found, chain.mu_s, rel_tol=ROUNDING))


def apparent_friction(chain: Chain, start: FloatArray | None, duration: float) -> float:
    """mu_sapp (Eq. 1) of a chain pushed from rest at some positions [m]; NaN without a global slip."""
    slips = find_slips(simulate(chain, duration, until="global slip", start_positions=start))
    if not slips["is_global"].any():
        return math.nan
    return float(up_to_first_global(slips)["load_before"].max()) / chain.normal_load


def _row(check: str, case: str, unit: str, expected: Any, found: Any, holds: bool) -> dict[str, Any]:
    names = ("check", "case", "unit", "expected", "found", "holds")
    return dict(zip(names, (check, case, unit, expected, found, bool(holds)), strict=True))
