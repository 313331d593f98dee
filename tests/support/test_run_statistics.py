"""Intervals of a median and of a share hold what they are about in 95 % of cases, and
in not many more."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest
from scipy.stats import binom

from maegawa2010.support.run_statistics import (
    compared,
    median_difference,
    median_interval,
    nine_tenths,
    share_interval,
)


@pytest.mark.parametrize(("n", "ends"), [(5, None), (6, (1, 6)), (40, (14, 27))])
def test_the_interval_of_a_median_ends_at_the_values_that_tables_of_order_statistics_have(
    n, ends
):
    interval = median_interval(
        np.random.default_rng(n).permutation(np.arange(1.0, n + 1))
    )
    assert interval == ends if ends else np.isnan(interval).all()


@pytest.mark.parametrize(("n", "largest_mean"), [(6, 0.99), (200, 0.965)])
def test_the_interval_of_a_share_holds_every_probability_in_at_least_95_of_100_cases(
    n, largest_mean
):
    """Summed over all numbers of hits. It is longer than it must be, the less so the
    larger n."""
    hits, probability = np.arange(n + 1), np.linspace(0.005, 0.995, 199)
    low, high = np.transpose([share_interval(k, n) for k in hits])[:, :, None]
    held = (low <= probability) & (probability <= high)
    covered = (binom.pmf(hits[:, None], n, probability) * held).sum(axis=0)
    assert (low[0], high[-1]) == (0.0, 1.0)
    assert covered.min() >= 0.95
    assert covered.mean() < largest_mean


def test_nine_tenths_of_21_numbers_lie_between_the_second_and_the_last_but_one():
    """0, 1, ..., 20, and one that is not known."""
    values = pd.Series([*np.random.default_rng(1).permutation(21), np.nan])
    expected = {"q05": 1.0, "q50": 10.0, "q95": 19.0}
    assert nine_tenths(values) == pytest.approx(expected)


def test_the_interval_of_a_difference_of_medians_ends_at_values_of_both():
    """Of 0, 1, ..., 39 the 13th from either end holds the median in 97.5 % of cases."""
    values = pd.Series(np.arange(40.0))
    assert median_difference(values + 100.0, values) == (100.0 - 15.0, 100.0 + 15.0)


@pytest.mark.parametrize(
    ("low", "high", "verdict"),
    [
        (-0.01, 0.01, "same"),
        (-0.02, 0.005, "undecided"),
        (0.011, 0.03, "different"),
    ],
)
def test_an_interval_lies_within_the_tolerance_across_its_edge_or_outside(
    low, high, verdict
):
    assert compared(low, high, tolerance=0.01) == verdict
