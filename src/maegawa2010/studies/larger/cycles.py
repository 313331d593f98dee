"""Stick-slip of the larger chain after its first slips: the cycles into which it
settles."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np
import pandas as pd

from maegawa2010.studies.larger.first_slips import (
    POINT,
    load_part,
    run_studies,
)
from precursors.larger.chain import LargerChain, simulate_larger
from precursors.larger.settled import settled
from precursors.model.chain import FloatArray

APART = 0.003  # two cycles whose mean peaks [F_Z] are closer are one
# Of the straight lines from which the net forces of a strained start are made.
NODES = 8
MEDIANS = ["coefficient", "precursors", "period", "state_error", "theory"]


def cycle_tables(
    slider: Mapping[str, Any], settings: Mapping[str, Any]
) -> dict[str, pd.DataFrame]:
    """Cycles of every point, and the peaks of some runs, by file name."""
    run = partial(run_past, settings)
    runs = run_studies(slider, settings["studies"], run, len(settings["pasts"]))
    return {
        "larger_cycles": cycles_table(runs),
        "larger_peaks": peaks_table(runs, settings),
    }


def run_past(
    settings: Mapping[str, Any],
    point: dict[str, Any],
    larger: LargerChain,
    step: float,
    index: int,
) -> dict[str, Any]:
    """Run a chain from one of many pasts until it settles: point, index of the past,
    theory (see `cycles_table`), and `settled`.

    `settings` has the seed, the duration [s], and pasts: pairs of noise in the normal
    loads and of strain at the start.
    """
    past = settings["pasts"][index % len(settings["pasts"])]
    random = np.random.default_rng([settings["seed"], index])
    drawn, forces = with_past(larger, past, random)
    run = simulate_larger(
        drawn, settings["duration"], "settled", step, start_forces=forces
    )
    chain = larger.chain
    share = load_part(chain, point["critical_length"])
    theory = chain.mu_k + (chain.mu_s - chain.mu_k) * share
    return (
        point
        | {"past": index, "theory": theory}
        | settled(run, point["critical_length"])
    )


def with_past(
    larger: LargerChain, past: tuple[float, float], random: np.random.Generator
) -> tuple[LargerChain, FloatArray]:
    """A chain with noise in its normal loads, whose sum stays, and spring forces at
    which it rests strained.

    `past` is the noise, relative to each load, and the largest net force on a block,
    relative to mu_s w. Net forces are straight lines between a few nodes, so that
    chains of any number of blocks have the same.
    """
    noise, strain = past
    weights = larger.chain.weights
    places = np.linspace(0.0, 1.0, len(weights))
    net = np.interp(places, np.linspace(0.0, 1.0, NODES), random.uniform(-1, 1, NODES))
    net -= (net @ weights) / weights.sum()  # F_X is 0
    net *= strain * larger.chain.strength / abs(net).max()
    noisy = weights * (1.0 + noise * random.uniform(-1.0, 1.0, len(weights)))
    noisy *= weights.sum() / noisy.sum()
    forces = np.append(0.0, -np.cumsum(net)[:-1])
    return replace(larger, chain=replace(larger.chain, weights=noisy)), forces


def cycles_table(runs: pd.DataFrame) -> pd.DataFrame:
    """All cycles of each point with their shares: a row for each cycle.

    Sorted coefficients are split where neighbours differ by more than `APART`; each
    group is a cycle. Its coefficient, precursors, period and state_error are medians
    over its runs; share is that of the point's `pasts` runs, and periodic the share of
    its runs that settled.
    theory is mu_k + (mu_s - mu_k) W(l_c)/F_Z, which for an even load is mu_k + (mu_s -
    mu_k) l_c/L.
    """
    rows = []
    for point, of_point in runs.groupby(POINT, sort=False):
        found = of_point.dropna(subset="coefficient").sort_values("coefficient")
        number = (found["coefficient"].diff() > APART).cumsum()
        for _, of_cycle in found.groupby(number):
            shares = {
                "pasts": len(of_point),
                "share": len(of_cycle) / len(of_point),
                "periodic": (of_cycle["period"] > 0).mean(),
            }
            medians = of_cycle[MEDIANS].median().to_dict()
            rows.append(dict(zip(POINT, point, strict=True)) | shares | medians)
    return pd.DataFrame(rows)


def peaks_table(runs: pd.DataFrame, settings: Mapping[str, Any]) -> pd.DataFrame:
    """Peaks of F_X/F_Z at the global slips of the chain `map`, in order, from one run
    of each past, in the first study that has it."""
    chain = pd.Series(settings["map"])
    of_chain = runs[(runs[chain.index] == chain).all(axis=1)]
    first = of_chain.head(len(settings["pasts"]))
    table = first.rename(columns={"peaks": "peak"}).explode("peak")
    return table[[*chain.index, "past", "peak"]].astype({"peak": float})
