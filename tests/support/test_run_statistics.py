"""Quantiles, and confidence intervals of medians, shares and differences of medians."""

import numpy as np
import pandas as pd
import pytest

from maegawa2010.support.run_statistics import (
    compared,
    median_difference,
    median_interval,
    nine_tenths,
    share_interval,
)


def test_the_interval_of_a_median_needs_six_values():
    """All six are below or above the median in 2 of 64 cases."""
    assert median_interval([3.0, 1.0, 6.0, 2.0, 5.0, 4.0]) == (1.0, 6.0)
    assert np.isnan(median_interval(np.arange(5.0))).all()


def test_interval_of_a_share_starts_at_zero_without_hits():
    """It ends at the share that gives no hit in 2.5 % of cases."""
    assert share_interval(0, 6) == pytest.approx((0.0, 1.0 - 0.025 ** (1 / 6)))


def test_quantiles_of_21_numbers_are_the_second_and_the_20th():
    """The numbers are 0, 1, ..., 20 and one NaN, which is ignored."""
    values = pd.Series([*np.random.default_rng(1).permutation(21), np.nan])
    expected = {"q05": 1.0, "q50": 10.0, "q95": 19.0}
    assert nine_tenths(values) == pytest.approx(expected)


def test_interval_of_a_difference_ends_at_values_of_both():
    """The 13th of 40 numbers from either end bounds the median in 97.5 % of cases."""
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
def test_interval_is_within_across_or_outside_the_tolerance(low, high, verdict):
    assert compared(low, high, tolerance=0.01) == verdict
