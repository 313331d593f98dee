"""Settled stick-slip of a run: its peaks, its precursors, and the law beside them."""

from typing import Any

import numpy as np
import pandas as pd

from precursors.analysis.slips import find_slips
from precursors.larger.chain import LargerChain
from precursors.larger.law import PAST, Law
from precursors.larger.steps import REPEATS, SETTLED, period_of
from precursors.solver.run import LargerRun, Record


def settled(run: Record, nucleus: float) -> dict[str, Any]:
    """Stick-slip into which a run has settled; `nucleus` is l_c/L.

    peaks are the F_X/F_Z at which global slips begin, and period is the number of slips
    after which they come again; 0 if they do not, and then the later half of the run
    counts. coefficient is their mean, and precursors the mean number of slip events
    before each, since the last global slip, whose fronts go beyond `PAST` l_c.
    """
    slips = events_of(run, nucleus).query("is_global")
    peaks = slips["peak"].to_numpy()
    period = period_of(peaks, SETTLED)
    is_late = slips["onset"] > 0.5 * run.duration
    late = slips.tail(period) if period else slips[is_late]
    return {
        "peaks": peaks,
        "period": period,
        "coefficient": late["peak"].mean(),
        "precursors": late["precursors"].mean(),
    }


def events_of(run: Record, nucleus: float) -> pd.DataFrame:
    """Global slips and precursors of a run (see `settled`) with their columns of
    `find_slips`; cycle is the number of global slips before, peak F_X/F_Z at the onset,
    and precursors how many have come since the last global slip."""
    slips = find_slips(run)
    is_past = slips["front"] > PAST * nucleus * run.chain.n_blocks
    slips = slips[is_past | slips["is_global"]]
    cycle = slips["is_global"].shift(fill_value=False).cumsum()
    return slips.assign(
        cycle=cycle,
        peak=slips["load_before"] / run.chain.weights.sum(),
        precursors=slips.groupby(cycle).cumcount(),
    )


def beside_law(run: LargerRun) -> dict[str, Any]:
    """Settled coefficient and precursors of a run, and those of the law.

    predicted_coefficient and predicted_precursors are those of the cycle that the law
    reaches from rest, with nothing counted. law_coefficient is its fixed point with the
    precursors of the run; before `REPEATS` global slips these and settled_coefficient
    are NaN.

    Raises
    ------
    ValueError
        If the chain is outside the limits of the law.
    """
    law = Law(LargerChain.of_run(run))
    found = settled(run, law.nucleus)
    cycle = law.cycle(law.rest)
    has_settled = len(found["peaks"]) >= REPEATS
    n = found["precursors"] if has_settled else np.nan
    return {
        "critical_length_m": law.nucleus * run.chain.length,
        "possible_precursors": " or ".join(f"{n:g}" for n in law.possible),
        "predicted_precursors": cycle.precursors,
        "predicted_coefficient": cycle.coefficient,
        "precursors": n,
        "law_coefficient": law.fixed_point(n).coefficient,
        "settled_coefficient": found["coefficient"] if has_settled else np.nan,
    }
