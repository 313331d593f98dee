"""The mean of F_X over the path of the drive in six runs, and how slips change the
distance R from kinetic balance (`precursors.analysis.balance`)."""

import math
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
import pandas as pd

from maegawa2010.studies.runs import predictable
from precursors.analysis.balance import balance, distance, drive_work
from precursors.analysis.load_curve import load_curve
from precursors.analysis.slips import slip_table
from precursors.model.chain import Chain
from precursors.solver.run import Run
from precursors.solver.simulate import simulate

# Columns of pixels of a panel. Two points in each column show all peaks.
PIXELS = 400


class Mean(NamedTuple):
    """Mean of F_X over a path of the drive, and the terms by which it differs from
    mu_k F_Z, all over F_Z: mean = mu_k + stored + backward - remainder."""

    mean: float
    stored: float  # by the change of R
    backward: float  # by backward sliding
    remainder: float  # that the identity does not explain


def balance_tables(
    sliders: Mapping[str, Mapping[str, Any]],
    n_blocks: Sequence[int],
    duration: float,
) -> dict[str, pd.DataFrame]:
    """The tables of the runs, by file name.

    balance.csv has a row for each run. Single events can be predicted until
    predictable_s. The columns of `Mean` and the largest F_X/F_Z are of the time from the
    onset of the first global slip to that of the last (first_s to last_s). `over_slips`
    gives further columns. balance_curves.csv has points of F_X/F_Z.
    """
    rows, curves = [], []
    for scene, slider in sliders.items():
        for n in n_blocks:
            chain = Chain.from_slider(**{**slider, "n_blocks": n})
            run = simulate(chain, duration)
            labels: dict[str, Any] = {"scene": scene, "n_blocks": n}
            labels["theta"] = chain.theta
            rows.append(labels | row_of(run))
            curves.append(curve(run).assign(**labels))
    return {
        "balance": pd.DataFrame(rows),
        "balance_curves": pd.concat(curves, ignore_index=True),
    }


def row_of(run: Run) -> dict[str, float]:
    """A row of balance.csv; numbers that need two global slips are NaN without them."""
    slips = slip_table(run)
    onsets = slips["onset_s"][slips["is_global"]]
    first, last = onsets.min(), onsets.max()
    is_lasting = first < last
    mean = mean_of(run, first, last) if is_lasting else Mean(*[math.nan] * 4)
    return {
        "mu_k": run.chain.mu_k,
        "predictable_s": predictable(run),
        "first_s": first,
        "last_s": last,
        **mean._asdict(),
        "largest": largest(run, first, last) if is_lasting else math.nan,
        **over_slips(run, slips),
    }


def mean_of(run: Run, start: float, end: float) -> Mean:
    """Mean of F_X from `start` to `end` [s], and its terms."""
    chain = run.chain
    terms = balance(run, start, end)
    unit = chain.normal_load * chain.drive_velocity * (end - start)
    return Mean(
        chain.mu_k + terms.work / unit,
        terms.change / unit,
        terms.backward / unit,
        terms.remainder / unit,
    )


def largest(run: Run, start: float, end: float) -> float:
    """Largest F_X/F_Z at a transition from `start` to `end` [s]."""
    times = run.transitions["time"]
    inside = run.transitions[(times >= start) & (times <= end)]
    return float(inside["tangential_load"].max()) / run.chain.normal_load


def over_slips(run: Run, slips: pd.DataFrame) -> dict[str, float]:
    """How slips change R, over R at their onset.

    change is the change of R. work is the work that the drive does during the slip, less
    that against kinetic friction. Both have a median and a largest value. slips is the
    number of slips; in slips_backward of them a block slides backward.
    """
    over = slips.dropna(subset="end_s")
    before, after = distance(run, over["onset_s"]), distance(run, over["end_s"])
    work = drive_work(run, over["end_s"]) - drive_work(run, over["onset_s"])
    backward = run.transitions["time"][run.transitions["mode"] == -1]
    n_backward = np.searchsorted(backward, [over["onset_s"], over["end_s"]])
    row: dict[str, float] = {"slips": len(over)}
    row["slips_backward"] = int(np.diff(n_backward, axis=0).astype(bool).sum())
    for name, joules in (("change", after - before), ("work", work)):
        share = pd.Series(abs(joules) / before)
        row |= {f"{name}_median": share.median(), f"{name}_largest": share.max()}
    return row


def curve(run: Run) -> pd.DataFrame:
    """F_X/F_Z as few points that look like all of them: the least and the largest in each
    column of pixels."""
    times, loads = load_curve(run)
    column = np.minimum(PIXELS * times // run.duration, PIXELS - 1)
    of_column = pd.Series(loads).groupby(column)
    shown = np.unique([0, len(times) - 1, *of_column.idxmin(), *of_column.idxmax()])
    load = loads[shown] / run.chain.normal_load
    return pd.DataFrame({"time_s": times[shown], "load": load})
