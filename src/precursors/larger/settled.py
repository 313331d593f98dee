"""Settled stick-slip of a run: its peaks, its precursors, and the law beside them."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd

from precursors.analysis.slips import find_slips
from precursors.larger.additions import ADDITIONS
from precursors.larger.chain import LargerChain
from precursors.larger.law import law_of
from precursors.larger.run import LargerRun
from precursors.larger.steps import REPEATS, SETTLED, period_of
from precursors.model.chain import FloatArray
from precursors.solver.run import Record

# Of l_c: an event whose front stops before is creep that trembles, and no precursor.
PAST = 1.1


def settled(run: Record, nucleus: float) -> dict[str, Any]:
    """Stick-slip into which a run has settled.

    peaks are the F_X/F_Z at which global slips begin, and period is the number of slips
    after which they come again; 0 if they do not, and then the later half of the run
    counts. coefficient is their mean, and precursors the mean number of slip events
    before each, since the last global slip, whose fronts go beyond `PAST` l_c; `nucleus`
    is l_c/L. state_error is the largest difference [F_Z] of a load
    at which a block changed its state, from one period to the next; NaN if different
    blocks did.
    """
    slips = peaks_of(run, nucleus)
    peaks = slips["peak"]
    period = period_of(peaks.to_numpy(), SETTLED)
    is_late = slips["onset"] > 0.5 * run.duration
    late = slips.tail(period) if period else slips[is_late]
    return {
        "peaks": peaks.to_numpy(),
        "period": period,
        "coefficient": late["peak"].mean(),
        "precursors": late["precursors"].mean(),
        "state_error": state_error(run, slips["onset"].to_numpy(), period),
    }


def peaks_of(run: Record, nucleus: float) -> pd.DataFrame:
    """Onset [s] of each global slip, F_X/F_Z there, and the number of precursors since
    the global slip before: see `settled`."""
    slips = find_slips(run)
    is_past = slips["front"] > PAST * nucleus * run.chain.n_blocks
    slips = slips[is_past | slips["is_global"]]
    places = np.flatnonzero(slips["is_global"])
    peaks = slips["load_before"] / run.chain.weights.sum()
    between = np.diff(places, prepend=-1) - 1
    return slips.assign(peak=peaks).iloc[places].assign(precursors=between)


def state_error(run: Record, onsets: FloatArray, period: int) -> float:
    """See `settled`."""
    if not period:
        return np.nan
    ends = onsets[[-1 - 2 * period, -1 - period, -1]]
    rows = run.transitions
    before, after = (
        np.sort(of_period, order="block")
        for of_period in np.split(rows, np.searchsorted(rows["time"], ends))[1:3]
    )
    if not np.array_equal(before["block"], after["block"]):
        return np.nan
    change = abs(after["tangential_load"] - before["tangential_load"])
    return float(change.max() / run.chain.weights.sum())


def beside_law(run: LargerRun) -> dict[str, Any]:
    """Settled coefficient and precursors of a run, and those of the law.

    settled_coefficient and precursors are NaN before `REPEATS` global slips. Then the
    law takes the least number of precursors that is possible.

    Raises
    ------
    ValueError
        If the chain is outside the limits of the law.
    """
    added = {name: run.numbers[name] for name in ADDITIONS}
    law = law_of(LargerChain(run.chain, **added))
    found = settled(run, law.nucleus)
    has_settled = len(found["peaks"]) >= REPEATS
    n = found["precursors"] if has_settled else min(law.possible, default=np.nan)
    return {
        "critical_length_m": law.nucleus * run.chain.length,
        "possible_precursors": " or ".join(map(str, law.possible)) or None,
        "precursors": found["precursors"] if has_settled else np.nan,
        "law_coefficient": law.coefficient(n),
        "settled_coefficient": found["coefficient"] if has_settled else np.nan,
        "least_coefficient": law.bound,
    }
