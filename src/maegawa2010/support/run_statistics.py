"""Statistics of one number over several runs: quantiles, and an interval that holds the
median."""

from typing import Any

import numpy as np
import pandas as pd
import scipy
from numpy.typing import ArrayLike

# Two intervals of this confidence hold both medians in 95 % of cases or more
# (Bonferroni).
EACH_OF_TWO = 0.975
# Relative noise in the normal loads of an ensemble: a tenth of what an experiment knows
# of them, and well above rounding.
NOISE = 1e-3
QUANTILES = {"q05": 0.05, "q50": 0.5, "q95": 0.95}


def nine_tenths(values: pd.Series) -> dict[str, float]:
    """Ends and middle of nine tenths of the values that are known."""
    return {name: float(values.quantile(part)) for name, part in QUANTILES.items()}


def median_interval(values: ArrayLike, share: float = 0.95) -> tuple[float, float]:
    """Interval that holds the median of what the values were drawn from, in at least
    this share of cases; NaN of too few values (below six for 95 %)."""
    found: Any = scipy.stats.quantile_test(
        np.asarray(values, float), p=0.5
    ).confidence_interval(share)
    return float(found.low), float(found.high)


def median_difference(values: pd.Series, others: pd.Series) -> tuple[float, float]:
    """95 % interval of the difference of two medians, for any distributions."""
    low, high = median_interval(values, EACH_OF_TWO)
    other_low, other_high = median_interval(others, EACH_OF_TWO)
    return low - other_high, high - other_low


def compared(low: float, high: float, tolerance: float) -> str:
    """Whether an interval of a difference lies within the tolerance, outside of it, or
    across its edge."""
    if -tolerance <= low and high <= tolerance:
        return "same"
    return "different" if low > tolerance or high < -tolerance else "undecided"


def share_interval(hits: int, of: int) -> tuple[float, float]:
    """95 % interval of a probability of which so many hits were seen (Clopper and
    Pearson): never too short."""
    found = scipy.stats.binomtest(hits, of).proportion_ci()
    return float(found.low), float(found.high)
