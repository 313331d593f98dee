"""The members of a study, which are runs (see `runs.py`), and statistics of the runs."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from itertools import combinations
from typing import Any

import numpy as np
import pandas as pd

from maegawa2010 import printed
from maegawa2010.support.run_statistics import (
    NOISE,
    compared,
    median_difference,
    nine_tenths,
)
from precursors.model.chain import SLIDER, Chain

# Columns that are left out of the table of a study if all members have the same value.
LEFT_OUT = {*SLIDER, "duration"} - {"theta", "n_blocks"}
CHAIN = ["scene", "theta", "n_blocks"]  # columns that identify a chain
# Two numbers count as the same if they differ by at most this: friction coefficients by
# one unit of the last digit of the paper's 0.49, times [s] by the precision to which the
# axis of Figs. 10-12 can be read.
TOLERANCES = {
    "mu_sapp": printed.LAST_DIGIT,
    "events_counted": 0.0,
    "events_to_global_slip": 0.0,
    "global_slip_s": 0.05,
}


@dataclass(frozen=True, eq=False)
class Study:
    """An ensemble of runs to the first global slip that differ in a few values.

    Attributes
    ----------
    members : DataFrame
        One row per run. Columns are arguments of `Chain.from_slider`; duration, the time
        limit of the run [s]; load_noise (see `chain_of`); group and draw, which select
        the random numbers; and labels.
    seed : int
        Seed of all random numbers.
    """

    members: pd.DataFrame
    seed: int = 0

    def chunk(self, i: int, n: int) -> Study:
        """Chunk i = 1..n: every n-th member from the i-th on, so that chunks have about
        the same work."""
        return replace(self, members=self.members.iloc[i - 1 :: n])


def stack(blocks: Iterable[Mapping[str, Any]]) -> pd.DataFrame:
    """Stack the members of several ensembles; each of `blocks` has a value or an array
    for every column."""
    return pd.concat([pd.DataFrame(block) for block in blocks], ignore_index=True)


def draws(runs: int) -> dict[str, Any]:
    """Columns of an ensemble: draw 0 without noise, then `runs` draws with noise."""
    draw = np.arange(runs + 1)
    return {"draw": draw, "load_noise": np.where(draw == 0, 0.0, NOISE)}


def chain_of(member: Mapping[Any, Any], seed: int = 0) -> Chain:
    """Chain of a member; it depends only on the member and the seed.

    Noise of size s changes each normal load to w_i (1 + s u_i) with u_i uniform in
    -1..1.
    """
    chain = Chain.from_slider(
        **{name: member[name] for name in SLIDER if name in member}
    )
    size = member.get("load_noise", 0.0)
    if size == 0.0:
        return chain
    stream = np.random.SeedSequence(seed, spawn_key=(member["group"], member["draw"]))
    change = size * np.random.default_rng(stream).uniform(-1, 1, chain.n_blocks)
    return replace(chain, weights=chain.weights * (1 + change))


def gather(chunks: Iterable[pd.DataFrame]) -> pd.DataFrame:
    """Join the chunks of a study to one table, without constant columns (`LEFT_OUT`).

    Raises
    ------
    ValueError
        If a chunk is missing or repeated.
    """
    together = pd.concat([table for table in chunks if len(table)]).sort_values(
        "member", ignore_index=True
    )
    if (together["member"] != together.index).any():
        raise ValueError("the chunks must have every member of their study once")
    table = together.drop(columns="member")
    constant = [name for name in LEFT_OUT & set(table) if len(set(table[name])) == 1]
    return table.drop(columns=constant)


def noise_table(members: pd.DataFrame) -> pd.DataFrame:
    """Distribution of each quantity over the noise.

    Returns
    -------
    DataFrame
        One row per chain and quantity: runs, the number of runs with noise; reached, how
        many of them have a global slip; and the quantiles of these (`nine_tenths`).
    """
    rows = []
    for values, of_chain in members.groupby(CHAIN, sort=False):
        runs = with_noise(of_chain)
        number = {"runs": int((of_chain["draw"] > 0).sum()), "reached": len(runs)}
        for quantity in TOLERANCES:
            labels = dict(zip(CHAIN, values, strict=True)) | {"quantity": quantity}
            rows.append(labels | number | nine_tenths(runs[quantity]))
    return pd.DataFrame(rows)


def differences_table(members: pd.DataFrame) -> pd.DataFrame:
    """Compare the medians of two loadings.

    Returns
    -------
    DataFrame
        One row per quantity and pair of scenes: difference of the medians, scene minus
        other, with its 95 % interval from low to high; tolerance; and the verdict of
        `compared`.
    """
    runs = with_noise(members)
    theta = runs.groupby("scene", sort=False)["theta"].first()
    rows = []
    for quantity, tolerance in TOLERANCES.items():
        values: dict[Any, pd.Series] = dict(
            iter(runs.groupby("scene", sort=False)[quantity])
        )
        for other, scene in combinations(values, 2):
            low, high = median_difference(values[scene], values[other])
            row = {
                "quantity": quantity,
                "scene": scene,
                "theta": theta[scene],
                "other": other,
                "difference": values[scene].median() - values[other].median(),
                "low": low,
                "high": high,
                "tolerance": tolerance,
                "verdict": compared(low, high, tolerance),
            }
            rows.append(row)
    return pd.DataFrame(rows)


def with_noise(members: pd.DataFrame) -> pd.DataFrame:
    """The runs with noise that have a global slip."""
    return members[(members["draw"] > 0) & members["reached"]]
