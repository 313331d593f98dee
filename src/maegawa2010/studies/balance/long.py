"""Longer runs, in full builds only: the mean of F_X for many chains, the distance R from
kinetic balance at the first global slip, the mean friction of each block, and mu_sapp
with a heavy block."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from functools import partial
from itertools import product
from typing import Any

import numpy as np
import pandas as pd

from maegawa2010.paper.committed import compared
from maegawa2010.studies.balance.long_run import (
    at_first_slip,
    lasting,
    mean_friction,
    of_blocks,
    of_lasting,
    of_load,
    of_slip,
)
from maegawa2010.studies.balance.tables import largest, mean_of
from maegawa2010.studies.members import chain_of, draws, stack
from maegawa2010.studies.runs import known_until, up_to_global_slip
from maegawa2010.support.run_statistics import NOISE, nine_tenths
from precursors.analysis.balance import distance
from precursors.analysis.summary import summarise
from precursors.model.chain import Chain, FloatArray
from precursors.solver.simulate import simulate
from precursors.support.waiting import in_threads

THETAS = ("-5/6", 0, "5/6")
# Stiffness K [N/m] and velocity V [m/s] of the drive.
DRIVES = {"drive_stiffness": (1e5, 8e5, 3e6), "drive_velocity": (1e-4, 5e-4, 3e-3)}
SECONDS = 10.0  # largest duration of a run to the first global slip
AT_REST = 1e-3  # s; a new slider does not slip earlier
# Normal loads at x from 0 to 1, up to a factor. As blocks shrink, the share of each of
# them in F_Z vanishes.
SHARED: dict[str, Callable[[FloatArray], FloatArray]] = {
    "even": np.ones_like,
    "bump": lambda x: 1.0 + 8.0 * np.exp(-(((x - 0.5) / 0.1) ** 2)),
    "notch": lambda x: 1.0 - 0.95 * np.exp(-(((x - 0.5) / 0.1) ** 2)),
    "alternating": lambda x: np.where(np.arange(len(x)) % 2, 9.0, 1.0),
}
# In other loads one block carries the share `HEAVY` of F_Z, at a place x; the rest is
# even.
HEAVY = 0.2
PLACES = {"heavy first": 0.0, "heavy middle": 0.5, "heavy last": 1.0}
# Tolerances for another machine, while single events can be predicted (`UNPREDICTED_S`):
# of loads over F_Z and friction over w_i, of R (relative), and of counts.
CLOSE = 1e-6
CLOSE_R = 1e-5
SAME = 0.0


def runs_table(
    slider: Mapping[str, Any], settings: Mapping[str, Any], seed: int
) -> pd.DataFrame:
    """One row per chain in lasting stick-slip.

    seconds is the time over which the mean is taken, and largest is the largest F_X/F_Z
    in this time. Further columns are those of `Mean` and of the beginning (`long_run`).
    """
    tasks = [
        partial(mean_row, varied, chain, seconds)
        for varied, chain, seconds in cases(slider, settings, seed)
    ]
    return pd.DataFrame(in_threads(tasks))


def cases(
    slider: Mapping[str, Any], settings: Mapping[str, Any], seed: int
) -> Iterator[tuple[str, Chain, float]]:
    """Yield what is varied in the slider, the chain, and the duration of its run [s]."""
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
    """Run a chain; return its row of balance_runs.csv."""
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
        **of_lasting(chain, known_until(run)),
    }


def blocks_table(slider: Mapping[str, Any], seconds: float) -> pd.DataFrame:
    """Mean friction of each block over its normal load, a row for each loading and
    block."""
    tables = []
    for theta in THETAS:
        chain = Chain.from_slider(**{**slider, "theta": theta})
        run, start = lasting(chain, seconds)
        friction = mean_friction(run, start, seconds) / chain.weights
        first = of_blocks(chain, known_until(run))
        tables.append(first.assign(theta=chain.theta, friction=friction))
    return pd.concat(tables, ignore_index=True)


def first_slips_table(
    sliders: Mapping[str, Mapping[str, Any]], settings: Mapping[str, Any], seed: int
) -> pd.DataFrame:
    """R at the first global slip, a row for each scene and number of blocks.

    runs is the number of runs with noise in the normal loads, and reached how many of
    them have a global slip. R_start_J is R of the new slider without noise. Columns that
    end in _q50 are medians of the numbers of `at_first_slip`.
    """
    rows = []
    for scene, slider in sliders.items():
        for n, runs in zip(settings["n_blocks"], settings["runs"], strict=True):
            new, *chains = noisy(slider, n, runs, seed)
            made = up_to_global_slip(chains, SECONDS)
            numbers = pd.DataFrame([at_first_slip(run) for run in made])
            row: dict[Any, Any] = {"scene": scene, "theta": new.theta, "n_blocks": n}
            row |= {"runs": runs, "reached": int(numbers["R_J"].notna().sum())}
            row |= {"R_start_J": distance(simulate(new, AT_REST), [0.0])[0]}
            row |= numbers.median().add_suffix("_q50").to_dict()
            rows.append(row | of_slip(chains[0], known_until(made[0])))
    return pd.DataFrame(rows)


def noisy(slider: Mapping[str, Any], n: int, runs: int, seed: int) -> list[Chain]:
    """A slider of n blocks: first without noise in its normal loads, then with noise."""
    member = {**slider, "n_blocks": n, **draws(runs), "group": n}
    return [chain_of(one, seed) for one in stack([member]).to_dict("records")]


def loads_table(
    slider: Mapping[str, Any], settings: Mapping[str, Any], seed: int
) -> pd.DataFrame:
    """mu_sapp under the loads of `SHARED` and those with a heavy block, a row for each
    load and number of blocks.

    share is the largest w_i/F_Z. reached is the number of runs with noise that have a
    global slip; the quantiles of mu_sapp (`nine_tenths`) are of these runs.
    """
    rows = []
    for load, n in product([*SHARED, *PLACES], settings["n_blocks"]):
        chains = loaded(slider, load, n, settings["runs"], seed)
        runs = up_to_global_slip(chains, SECONDS)
        summary = summarise(runs)
        row = {"load": load, "n_blocks": n, "share": weights_of(load, n).max()}
        row |= {"runs": len(runs), "reached": int(summary["reached"].sum())}
        row |= nine_tenths(summary["mu_sapp"])
        rows.append(row | of_load(chains[0], known_until(runs[0])))
    return pd.DataFrame(rows)


def loaded(
    slider: Mapping[str, Any], load: str, n: int, runs: int, seed: int
) -> list[Chain]:
    """Sliders of n blocks under a load, with noise."""
    chain = Chain.from_slider(**{**slider, "n_blocks": n})
    weights = weights_of(load, n) * chain.normal_load
    random = np.random.default_rng([seed, n])
    noise = NOISE * random.uniform(-1, 1, (runs, n))
    return [replace(chain, weights=weights * (1 + one)) for one in noise]


def weights_of(load: str, n: int) -> FloatArray:
    """Shares w_i/F_Z of a load, a key of `SHARED` or `PLACES`, shape (n,)."""
    if load in SHARED:
        weights = SHARED[load]((np.arange(n) + 0.5) / n)
        return weights / weights.sum()
    weights = np.full(n, (1.0 - HEAVY) / (n - 1))
    weights[round(PLACES[load] * (n - 1))] = HEAVY
    return weights


def check(
    tables: Mapping[str, pd.DataFrame],
    slider: Mapping[str, Any],
    sliders: Mapping[str, Mapping[str, Any]],
    settings: Mapping[str, Any],
) -> pd.DataFrame:
    """Compare the beginnings in committed tables (by name) with those made again."""
    seed = settings["seed"]
    runs = tables["balance_runs"].reset_index(names="case")
    blocks, loads, slips = (
        tables[f"balance_{name}"] for name in ("blocks", "loads", "first_slips")
    )
    means = [
        {"case": case, "varied": varied, **of_lasting(chain, known_s)}
        for (case, known_s), (varied, chain, _) in zip(
            runs["known_s"].items(), cases(slider, settings["runs"], seed), strict=False
        )
    ]
    frictions = []
    for theta, known_s in blocks.groupby("theta")["known_s"].first().items():
        chain = Chain.from_slider(**{**slider, "theta": theta})
        frictions += (
            of_blocks(chain, known_s).assign(theta=chain.theta).to_dict("records")
        )
    of_loads = []
    for load, n, known_s in loads[["load", "n_blocks", "known_s"]].to_numpy():
        (chain,) = loaded(slider, load, n, 1, seed)
        of_loads.append({"load": load, "n_blocks": n, **of_load(chain, known_s)})
    of_slips = []
    for scene, n, known_s in slips[["scene", "n_blocks", "known_s"]].to_numpy():
        _, chain = noisy(sliders[scene], n, 1, seed)
        of_slips.append({"scene": scene, "n_blocks": n, **of_slip(chain, known_s)})
    counted = {"first_transitions": SAME, "first_mean": CLOSE}
    of_events = {"first_events": SAME, "first_largest": CLOSE}
    near = {"first_R_J": CLOSE_R * slips["first_R_J"], "first_line_rms": CLOSE}
    friction = {"first_friction": CLOSE}
    comparisons = [
        compared("balance_runs", runs, means, ["case", "varied"], counted),
        compared("balance_blocks", blocks, frictions, ["theta", "block"], friction),
        compared("balance_loads", loads, of_loads, ["load", "n_blocks"], of_events),
        compared("balance_first_slips", slips, of_slips, ["scene", "n_blocks"], near),
    ]
    return pd.concat(comparisons, ignore_index=True)
