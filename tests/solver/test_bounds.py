"""The root search never steps over a root: each of its bounds against the whole series, on random windows."""

from __future__ import annotations

import math

import numpy as np
import pytest
from random_chains import trial

from precursors import Chain
from precursors.methods.stability import stiffness_matrix
from precursors.solver.kernel import bounds, roots
from precursors.solver.kernel.arrays import Search
from precursors.solver.kernel.layout import FINAL, LEVELS, NEGLIGIBLE, REACH, ROWS, WHOLE, order_for
from precursors.solver.kernel.units import scale

WINDOWS = 400
ROUNDING = 1e-12  # of a window; numpy.roots knows a simple root to some roundings
# A bound that is far too small costs time. In a typical window one step reaches this part of the way to
# the root, and the four steps of the cubic this part.
ONE_STEP, FOUR_STEPS = 0.3, 0.8
# Gershgorin's bound over the largest frequency: the ends of a short chain make it loose.
LOOSEST = 1.35


def series(seed: int, n: int = 12) -> np.ndarray:
    """c_0 > 0 and terms of either sign that fall off like those of a Taylor series."""
    random = np.random.default_rng(seed)
    terms = random.standard_normal(n) * 2.0 ** np.arange(n) / [math.factorial(k) for k in range(n)]
    return np.append(abs(terms[:1]), terms[1:])


def first_root(c: np.ndarray) -> float:
    """First root in [0, 1], or infinity."""
    found = np.roots(c[::-1])
    real = found.real[(abs(found.imag) < 1e-9) & (found.real >= 0.0) & (found.real <= 1.0)]
    return float(real.min(initial=np.inf))


def search_of(c: np.ndarray, zero: float = 1e-15) -> Search:
    """One slot of the search that watches a series in the window [0, 1]."""
    level = np.zeros((1, LEVELS))
    level[0, :3] = 0.0, 1.0, zero
    whole = np.zeros((1, ROWS + 1))
    whole[0, : len(c)] = c
    numbers = np.zeros((3, 8), np.int64)
    return Search(whole, level, np.zeros(8), *numbers)


@pytest.fixture(scope="module")
def windows() -> list[tuple[np.ndarray, float]]:
    drawn = [series(seed) for seed in range(WINDOWS)]
    found = [(c, first_root(c)) for c in drawn]
    assert 100 < sum(root <= 1.0 for _, root in found) < WINDOWS - 100
    return found


def curvature(c: np.ndarray) -> float:
    """Bound of |g''| on [0, 1]."""
    n = np.arange(len(c))
    return float((n * (n - 1) * abs(c)).sum())


def test_one_step_passes_no_root_and_is_not_far_too_short(windows):
    steps = [(bounds.safe_step.py_func(c[0], c[1], curvature(c)), root) for c, root in windows]
    assert all(step <= root + ROUNDING for step, root in steps)
    assert np.median([step / root for step, root in steps if root <= 1.0]) > ONE_STEP


def test_the_cubic_passes_no_root_whatever_the_sign_of_the_rest(windows):
    shares = []
    for c, root in windows:
        rest = abs(c[4:]).sum()
        found = bounds.cubic_bound.py_func(*c[:4], rest)
        worst = first_root(np.array([*c[:4], -rest]))
        assert found <= min(root, worst) + ROUNDING
        if worst <= 1.0:
            shares.append(found / worst)
    assert np.median(shares) > FOUR_STEPS


def test_what_is_surely_positive_has_no_root(windows):
    sure = [root for c, root in windows if bounds.surely_positive.py_func(*c[:4], abs(c[4:]).sum())]
    assert len(sure) > WINDOWS / 20
    assert min(sure) == np.inf


@pytest.mark.parametrize("shift", [0, 1, 2])
def test_the_search_ends_at_the_first_root_or_proves_that_there_is_none(windows, shift):
    """Also where the series begins with roots at the start, which were dealt with already."""
    for c, root in windows:
        search = search_of(np.append(np.zeros(shift), c))
        bound = roots.examine.py_func(0, len(c) + shift, search)
        for _ in range(200):
            assert bound <= root + ROUNDING or bound > 1.0 <= root
            if search.stage[0] == FINAL or not bound <= 1.0:
                break
            assert search.stage[0] == WHOLE
            bound = roots.refine.py_func(0, bound, search)
        assert bound == pytest.approx(root, abs=1e-9) if root <= 1.0 else bound > 1.0


@pytest.mark.parametrize("n_blocks", [1, 2, 3, 10, 60])
@pytest.mark.parametrize("ratio", [1e-3, 0.032, 1.0, 1e3])
def test_the_unit_of_time_is_within_the_reach_of_the_series(n_blocks, ratio):
    """omega tau <= 2 for every frequency, from the eigenvalues; else the cut series would lose digits."""
    chain = Chain(np.ones(n_blocks), 2e-3, 1e6, ratio * 1e6, 1e-4, 0.7, 0.45)
    omega = math.sqrt(np.linalg.eigvalsh(stiffness_matrix(chain))[-1] / chain.mass)
    assert omega * scale(chain).tau <= REACH * (1 + 1e-14)
    if n_blocks > 2:
        assert omega * scale(chain).tau > REACH / LOOSEST


@pytest.mark.parametrize("number", range(0, 60, 4))
def test_any_chain_is_within_the_reach_too(number):
    chain = trial(number)[1].chain
    omega = math.sqrt(max(np.linalg.eigvalsh(stiffness_matrix(chain))[-1], 0.0) / chain.mass)
    assert omega * scale(chain).tau <= REACH * (1 + 1e-14)


@pytest.mark.parametrize("length", [0.25, 0.5, 0.6875, 1.0])
def test_the_order_leaves_out_less_than_a_rounding(length):
    n = order_for(length)
    assert (REACH * length) ** n / math.factorial(n) <= NEGLIGIBLE
    assert n == 8 or (REACH * length) ** (n - 1) / math.factorial(n - 1) > NEGLIGIBLE
