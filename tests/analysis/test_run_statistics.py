"""The interval of a median has the ends and the share of cases that order statistics promise."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest

from precursors.analysis.run_statistics import median_interval, statistics


@pytest.mark.parametrize(
    ("n", "ends"),
    [(0, None), (5, None), (6, (1, 6)), (7, (1, 7)), (9, (2, 8)), (20, (6, 15)), (40, (14, 27))],
)
def test_the_interval_of_a_median_ends_at_the_values_that_tables_of_order_statistics_have(n, ends):
    interval = median_interval(np.random.default_rng(n).permutation(np.arange(1.0, n + 1)))
    assert interval == ends if ends else np.isnan(interval).all()


def test_the_interval_of_a_median_holds_it_as_often_as_it_says_whatever_the_distribution():
    n_draws = 2000
    draws = np.random.default_rng(2013).exponential(size=(n_draws, 12))
    held = [low <= np.log(2) <= high for low, high in map(median_interval, draws)]
    # By the binomial distribution, to three standard errors of so many draws.
    assert np.mean(held) == pytest.approx(0.9614, abs=3 * np.sqrt(0.04 * 0.96 / n_draws))


def test_values_that_are_not_known_do_not_count():
    found = statistics(pd.Series([1.0, np.nan, 3.0]))
    assert (found["mean"], found["q50"], found["n"]) == (2.0, 2.0, 2)
