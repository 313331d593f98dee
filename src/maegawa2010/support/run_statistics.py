"""Statistics of one quantity over several runs: quantiles and confidence intervals."""

from typing import Any

import numpy as np
import pandas as pd
import scipy
from numpy.typing import ArrayLike

# With this confidence for each of two intervals, both contain their medians with at least
# 95 % (Bonferroni).
EACH_OF_TWO = 0.975
# Relative noise in the normal loads of an ensemble: a tenth of the uncertainty of an
# experiment, and well above rounding.
NOISE = 1e-3
QUANTILES = {"q05": 0.05, "q50": 0.5, "q95": 0.95}


def nine_tenths(values: pd.Series) -> dict[str, float]:
    """5, 50 and 95 % quantiles of the values that are not NaN."""
    return {name: float(values.quantile(part)) for name, part in QUANTILES.items()}


def median_interval(values: ArrayLike, share: float = 0.95) -> tuple[float, float]:
    """Interval that contains the true median with at least the confidence `share`; NaN
    for too few values (fewer than six for 95 %)."""
    interval: Any = scipy.stats.quantile_test(
        np.asarray(values, float), p=0.5
    ).confidence_interval(share)
    return float(interval.low), float(interval.high)


def median_difference(values: pd.Series, others: pd.Series) -> tuple[float, float]:
    """95 % interval of the difference of two medians, for any distributions."""
    low, high = median_interval(values, EACH_OF_TWO)
    other_low, other_high = median_interval(others, EACH_OF_TWO)
    return low - other_high, high - other_low


def compared(low: float, high: float, tolerance: float) -> str:
    """Verdict on a difference from its interval: "same" if all of it is within the
    tolerance, "different" if none is, and "undecided" otherwise."""
    if -tolerance <= low and high <= tolerance:
        return "same"
    return "different" if low > tolerance or high < -tolerance else "undecided"


def share_interval(hits: int, of: int) -> tuple[float, float]:
    """95 % interval of a probability from `hits` in `of` trials (Clopper and Pearson)."""
    interval = scipy.stats.binomtest(hits, of).proportion_ci()
    return float(interval.low), float(interval.high)
