"""Longer runs, in full studies only: the mean of F_X for many chains, R at the first
global slip, the mean friction of each block, and mu_sapp with a heavy block."""

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from functools import partial
from itertools import product
from typing import Any

import numpy as np
import pandas as pd

from maegawa2010.studies.balance.tables import largest, mean_of
from maegawa2010.studies.members import chain_of, draws, stack
from maegawa2010.studies.runs import up_to_global_slip
from maegawa2010.support.run_statistics import NOISE, nine_tenths
from precursors.analysis.balance import distance
from precursors.analysis.slips import find_precursors, slip_table
from precursors.analysis.summary import summarise, summary_of
from precursors.model.chain import Chain, FloatArray
from precursors.model.statics import maximal_compressions, positions_from_compressions
from precursors.solver.run import Run
from precursors.solver.simulate import simulate
from precursors.support.waiting import in_threads

THETAS = ("-5/6", 0, "5/6")
# Stiffness K [N/m] and velocity V [m/s] of the drive: the least is a thirtieth of the
# largest.
DRIVES = {"drive_stiffness": (1e5, 8e5, 3e6), "drive_velocity": (1e-4, 5e-4, 3e-3)}
LEFT_OUT = 0.2  # of a run, at its start
MOST_TRANSITIONS = 30_000_000
SECONDS = 10.0  # after which a run without a global slip is given up
# Points between two transitions, at which forces are read for their mean.
POINTS = 8
# Normal loads at places x from 0 to 1, but for a factor. Where no block keeps a share as
# blocks shrink:
SHARED: dict[str, Callable[[FloatArray], FloatArray]] = {
    "even": np.ones_like,
    "bump": lambda x: 1.0 + 8.0 * np.exp(-(((x - 0.5) / 0.1) ** 2)),
    "notch": lambda x: 1.0 - 0.95 * np.exp(-(((x - 0.5) / 0.1) ** 2)),
    "alternating": lambda x: np.where(np.arange(len(x)) % 2, 9.0, 1.0),
}
# Where one block carries `HEAVY` of an even load, and its place.
HEAVY = 0.2
PLACES = {"heavy first": 0.0, "heavy middle": 0.5, "heavy last": 1.0}


def runs_table(
    slider: Mapping[str, Any], settings: Mapping[str, Any], seed: int
) -> pd.DataFrame:
    """One row per chain in lasting stick-slip: seconds, over which the mean is taken;
    the columns of `Mean`; largest, the largest F_X/F_Z then."""
    tasks = [
        partial(mean_row, varied, chain, seconds)
        for varied, chain, seconds in cases(slider, settings, seed)
    ]
    return pd.DataFrame(in_threads(tasks))


def cases(
    slider: Mapping[str, Any], settings: Mapping[str, Any], seed: int
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
    random = np.random.default_rng(seed)
    for _ in range(settings["draws"]):
        weights = random.uniform(size=own.n_blocks)
        weights *= own.normal_load / weights.sum()
        yield "weights", replace(own, weights=weights), longest
    for mu_k, theta in product(settings["mu_k"], THETAS):
        chain = Chain.from_slider(**{**slider, "mu_k": mu_k, "theta": theta})
        yield "mu_k", chain, settings["mu_k_seconds"]


def mean_row(varied: str, chain: Chain, seconds: float) -> dict[str, Any]:
    """Drive a chain: a row of balance_runs.csv."""
    run, start = lasting(chain, seconds)
    return {
        "varied": varied,
        "theta": chain.theta,
        "n_blocks": chain.n_blocks,
        **{name: getattr(chain, name) for name in DRIVES},
        "mu_k": chain.mu_k,
        "seconds": seconds - start,
        **mean_of(run, start, seconds)._asdict(),
        "largest": largest(run, start, seconds),
    }


def lasting(chain: Chain, seconds: float) -> tuple[Run, float]:
    """A run from rest in kinetic balance, where R = 0, and from when on it counts [s]."""
    sliding = chain.mu_k / chain.mu_s * maximal_compressions(chain)
    start = positions_from_compressions(sliding)
    run = simulate(
        chain, seconds, start_positions=start, max_transitions=MOST_TRANSITIONS
    )
    return run, LEFT_OUT * seconds


def blocks_table(slider: Mapping[str, Any], seconds: float) -> pd.DataFrame:
    """Mean friction of each block over its normal load, a row for each loading and
    block."""
    tables = []
    for theta in THETAS:
        chain = Chain.from_slider(**{**slider, "theta": theta})
        run, start = lasting(chain, seconds)
        friction = mean_friction(run, start, seconds) / chain.weights
        block = np.arange(1, chain.n_blocks + 1)
        row = {"theta": chain.theta, "block": block, "friction": friction}
        tables.append(pd.DataFrame(row))
    return pd.concat(tables, ignore_index=True)


def mean_friction(run: Run, start: float, end: float) -> FloatArray:
    """Mean friction of each block from `start` to `end` [s], in N, shape (N,): what its
    springs push it with, less what has gone into its velocity."""
    inside = run.transitions["time"]
    edges = np.unique([start, *inside[(inside > start) & (inside < end)], end])
    last = len(edges) - 1
    parts = np.linspace(0, last, last * POINTS + 1)
    times = np.interp(parts, np.arange(last + 1), edges)
    forces, velocities = run.forces_and_velocities(times)
    push = np.trapezoid(forces, times, axis=0) / (end - start)
    gained = run.chain.mass * (velocities[-1] - velocities[0]) / (end - start)
    return push - np.append(push[1:], 0.0) - gained


def first_slips_table(
    sliders: Mapping[str, Mapping[str, Any]], settings: Mapping[str, Any], seed: int
) -> pd.DataFrame:
    """R at the first global slip, a row for each scene and number of blocks.

    runs have noise in the normal loads, and reached a global slip. R_start_J is R of the
    new slider. The others are as `at_first_slip` has them, of the chain as it is, and
    medians (_q50) over the noise.
    """
    rows = []
    for scene, slider in sliders.items():
        for n, runs in zip(settings["n_blocks"], settings["runs"], strict=True):
            member = {**slider, "n_blocks": n, **draws(runs), "group": n}
            members = stack([member]).to_dict("records")
            chains = [chain_of(one, seed) for one in members]
            made = up_to_global_slip(chains, SECONDS)
            numbers = pd.DataFrame([at_first_slip(run) for run in made])
            row = {"scene": scene, "theta": chains[0].theta, "n_blocks": n}
            row |= {"runs": runs, "reached": int(numbers["R_J"][1:].notna().sum())}
            row |= {"R_start_J": distance(made[0], [0.0])[0], **numbers.iloc[0]}
            rows.append(row | numbers[1:].median().add_suffix("_q50").to_dict())
    return pd.DataFrame(rows)


def at_first_slip(run: Run) -> dict[str, float]:
    """R at the onset of the first global slip [J], or NaN; bound = sqrt(2 K R)/F_Z, which F_X/F_Z
    then keeps to mu_k; excess = mu_sapp - mu_k. Of the events of Fig. 13 the median
    bound on the distance of F_X/F_Z from the line F_X = mu_k W(L_p), line_bound, and
    the root mean square of that distance, line_rms.
    """
    chain = run.chain
    slips = slip_table(run)
    counted = find_precursors(slips)
    onset, front = counted["onset_s"].to_numpy(), counted["front"].to_numpy()
    left = np.array([distance(run, t, n)[0] for t, n in zip(onset, front, strict=True)])
    carried = chain.mu_k * np.cumsum(chain.weights)[front - 1]
    bounds = np.sqrt(2.0 * chain.drive_stiffness * left) / chain.normal_load
    reached = counted["is_global"].iloc[-1]
    miss = (counted["load_before_N"] - carried) / chain.normal_load
    return {
        "R_J": left[-1] if reached else math.nan,
        "bound": bounds[-1] if reached else math.nan,
        "excess": summary_of(slips).mu_sapp - chain.mu_k,
        "line_bound": float(np.median(bounds)),
        "line_rms": float(np.sqrt(np.mean(miss**2))),
    }


def loads_table(
    slider: Mapping[str, Any], settings: Mapping[str, Any], seed: int
) -> pd.DataFrame:
    """mu_sapp under loads that many blocks share and under loads with a heavy block, a
    row for each load and number of blocks.

    share is the largest w_i/F_Z, reached how many of the runs with noise have a global
    slip, and `nine_tenths` of mu_sapp are of those.
    """
    rows = []
    for load, n in product([*SHARED, *PLACES], settings["n_blocks"]):
        chain = Chain.from_slider(**{**slider, "n_blocks": n})
        weights = weights_of(load, n) * chain.normal_load
        random = np.random.default_rng([seed, n])
        noise = NOISE * random.uniform(-1, 1, (settings["runs"], n))
        chains = [replace(chain, weights=weights * (1 + one)) for one in noise]
        runs = up_to_global_slip(chains, SECONDS)
        found = summarise(runs)
        row = {"load": load, "n_blocks": n, "share": weights.max() / chain.normal_load}
        row |= {"runs": len(runs), "reached": int(found["reached"].sum())}
        rows.append(row | nine_tenths(found["mu_sapp"]))
    return pd.DataFrame(rows)


def weights_of(load: str, n: int) -> FloatArray:
    """Shares w_i/F_Z of a load, a key of `SHARED` or `PLACES`, shape (n,)."""
    if load in SHARED:
        weights = SHARED[load]((np.arange(n) + 0.5) / n)
        return weights / weights.sum()
    weights = np.full(n, (1.0 - HEAVY) / (n - 1))
    weights[round(PLACES[load] * (n - 1))] = HEAVY
    return weights
