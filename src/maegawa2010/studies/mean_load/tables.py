"""The time mean of F_X in lasting stick-slip: it is mu_k F_Z for every loading, number
of blocks and drive (`precursors.analysis.mean_load`)."""

from collections.abc import Iterator, Mapping
from dataclasses import replace
from functools import partial
from itertools import product
from typing import Any

import numpy as np
import pandas as pd

from precursors.analysis.mean_load import mean_load
from precursors.model.chain import Chain
from precursors.model.statics import maximal_compressions, positions_from_compressions
from precursors.solver.simulate import simulate
from precursors.support.waiting import in_threads

THETAS = ("-5/6", 0, "5/6")
# Stiffness K [N/m] and velocity V [m/s] of the drive: the least is a thirtieth of the
# largest.
DRIVES = {"drive_stiffness": (1e5, 8e5, 3e6), "drive_velocity": (1e-4, 5e-4, 3e-3)}
LEFT_OUT = 0.2  # of a run, at its start
MOST_TRANSITIONS = 30_000_000


def mean_load_table(
    slider: Mapping[str, Any], settings: Mapping[str, Any]
) -> pd.DataFrame:
    """One row per chain: seconds, over which the mean is taken; mean, stored and
    backward, see `MeanLoad`; largest, the largest F_X/F_Z at a transition then.

    Each chain starts at rest with F_X = mu_k F_Z, and with mu_k w_i from each block.
    """
    tasks = [
        partial(mean_of, varied, chain, seconds)
        for varied, chain, seconds in cases(slider, settings)
    ]
    return pd.DataFrame(in_threads(tasks))


def cases(
    slider: Mapping[str, Any], settings: Mapping[str, Any]
) -> Iterator[tuple[str, Chain, float]]:
    """What differs from the slider, the chain, and how long it is driven [s]."""
    sizes = dict(zip(settings["n_blocks"], settings["seconds"], strict=True))
    for n, theta in product(sizes, THETAS):
        chain = Chain.from_slider(**{**slider, "n_blocks": n, "theta": theta})
        yield "blocks", chain, sizes[n]
    own = Chain.from_slider(**slider)
    longest = max(sizes.values())
    for values in product(*DRIVES.values()):
        drive = dict(zip(DRIVES, values, strict=True))
        chain = Chain.from_slider(**{**slider, **drive})
        yield "drive", chain, longest * own.loading_rate / chain.loading_rate
    random = np.random.default_rng(settings["seed"])
    for _ in range(settings["draws"]):
        weights = random.uniform(size=own.n_blocks)
        weights *= own.normal_load / weights.sum()
        yield "weights", replace(own, weights=weights), longest


def mean_of(varied: str, chain: Chain, seconds: float) -> dict[str, Any]:
    """Drive a chain from mu_k F_Z: a row of mean_load.csv."""
    sliding = chain.mu_k / chain.mu_s * maximal_compressions(chain)
    run = simulate(
        chain,
        seconds,
        start_positions=positions_from_compressions(sliding),
        max_transitions=MOST_TRANSITIONS,
    )
    start = LEFT_OUT * seconds
    late = run.transitions[run.transitions["time"] >= start]
    return {
        "varied": varied,
        "theta": chain.theta,
        "n_blocks": chain.n_blocks,
        **{name: getattr(chain, name) for name in DRIVES},
        "seconds": seconds - start,
        **mean_load(run, start, seconds)._asdict(),
        "largest": late["tangential_load"].max() / chain.normal_load,
    }
