"""The larger chain before its first global slip: where creep runs away, and how many
events it has."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from functools import partial
from itertools import product
from typing import Any

import numpy as np
import pandas as pd

from precursors.analysis.slips import find_precursors, find_slips
from precursors.analysis.summary import apparent_friction
from precursors.larger.chain import (
    LargerChain,
    critical_length,
    simulate_larger,
    weakening_velocity,
)
from precursors.model.chain import Chain
from precursors.model.statics import longest_run
from precursors.solver.run import Record
from precursors.solver.simulate import simulate
from precursors.support.compiled import untyped
from precursors.support.waiting import in_threads

# Of `simulate_larger`, for chains of up to 100 blocks whose friction weakens: half of it
# changes settled peaks by less than 1e-3.
STEP = 0.25
# Fall of F_X, over F_X, that ends smooth growth: creep that trembles lets it fall by
# less.
SEEN = 0.002
DROP = 0.4  # of F_X [N], from which an event is large
SAMPLE = 1e-3  # s: a logger at 1 kHz takes two events with a shorter rest for one
POINT = [
    "study",
    "length",
    "relaxation_time",
    "weakening_velocity",
    "push_height",
    "normal_load",
    "theta",
    "n_blocks",
    "critical_length",
]


def points(
    slider: Mapping[str, Any], name: str, study: Mapping[str, Any]
) -> Iterator[tuple[dict[str, Any], LargerChain]]:
    """Every point of a study: its columns `POINT`, and its chain.

    `slider` has the arguments of `Chain.from_slider`. `study` has pairs of l_c/L (for
    an even load; 0 is Coulomb friction) and t_v [s], theta, n_blocks, and optionally
    push_height [m] and normal_load [N]. v_c is that of the pair at the slider's own
    normal load. critical_length is l_c/L at the point itself.
    """
    axes = {"push_height": [0.0], "normal_load": [slider["normal_load"]], **study}
    names = ["pairs", "push_height", "normal_load", "theta", "n_blocks"]
    for pair, height, load, theta, n in product(*(axes[name] for name in names)):
        v_c = weakening_velocity(Chain.from_slider(**slider), *pair)
        own = {"normal_load": load, "theta": theta, "n_blocks": n}
        chain = Chain.from_slider(**{**slider, **own})
        larger = LargerChain(chain, v_c, pair[1], push_height=height)
        l_c = critical_length(larger) / chain.length
        values = (name, *pair, v_c, height, load, chain.theta, n, l_c)
        yield dict(zip(POINT, values, strict=True)), larger


def run_studies(
    slider: Mapping[str, Any],
    studies: Mapping[str, Mapping[str, Any]],
    run: Callable[..., dict[str, Any]],
    repeats: int = 1,
) -> pd.DataFrame:
    """Run every point of some studies, on all threads: a row for each point and draw.

    A study is that of `points`; it may have a step other than `STEP`, and the
    number of `runs` (by default one), each of them repeated so many times. `run`
    (point, chain, step, number of the draw) returns a row.
    """
    tasks = [
        partial(run, point, larger, study.get("step", STEP), draw)
        for name, study in studies.items()
        for point, larger in points(slider, name, study)
        for draw in range(repeats * study.get("runs", 1))
    ]
    return pd.DataFrame(in_threads("running", tasks, untyped.config.NUMBA_NUM_THREADS))


def larger_tables(
    slider: Mapping[str, Any], settings: Mapping[str, Any]
) -> dict[str, pd.DataFrame]:
    """First slips, and where creep runs away, by file name."""
    runs = run_studies(slider, settings["studies"], partial(run_draw, settings))
    creep = {"nucleation": settings["nucleation"]}
    return {
        "larger": medians_table(runs),
        "larger_nucleation": run_studies(slider, creep, run_creep),
    }


def run_creep(
    point: dict[str, Any], larger: LargerChain, step: float, _: int
) -> dict[str, Any]:
    """Length at which smooth growth ends: a row of larger_nucleation.csv.

    Creep of length l behind the drive needs F_X = mu_s W(l), W the cumulative normal
    load. So the load at which the first event begins gives the length that crept until
    then, if events in which F_X falls by less than `SEEN` are left out. Columns beside
    `POINT`: measured [L], and ratio, measured over theory.
    """
    chain = larger.chain
    # The drive reaches mu_s F_Z in a tenth of the longest run.
    part = min(1.0, 1.3 * load_part(chain, point["critical_length"]))
    slips = find_slips(
        simulate_larger(larger, 0.1 * part * longest_run(chain), step=step)
    )
    falls = slips["load_after"] < (1.0 - SEEN) * slips["load_before"]
    first = slips["load_before"].iloc[falls.argmax()]
    ends = np.append(0.0, np.cumsum(chain.strength))
    measured = np.interp(first, ends, np.linspace(0.0, 1.0, len(ends)))
    ratio = measured / point["critical_length"]
    return point | {"measured": measured, "ratio": ratio}


def load_part(chain: Chain, length: float) -> float:
    """Part of the normal load on the first part `length` of the contact [1]."""
    ends = np.append(0.0, np.cumsum(chain.weights)) / chain.weights.sum()
    return float(np.interp(length, np.linspace(0.0, 1.0, len(ends)), ends))


def run_draw(
    settings: Mapping[str, Any],
    point: dict[str, Any],
    larger: LargerChain,
    step: float,
    draw: int,
) -> dict[str, Any]:
    """Run a chain to its first global slip: point, and `numbers` of the run.

    The normal loads have noise (relative), which depends on the seed, the number of
    blocks and the draw only. The first draw of a chain with a length says what half the
    step changes (halved_mu_sapp).
    """
    n = larger.chain.n_blocks
    random = np.random.default_rng([settings["seed"], n, draw])
    noise = 1.0 + settings["noise"] * random.uniform(-1.0, 1.0, n)
    chain = replace(larger.chain, weights=larger.chain.weights * noise)
    drawn = replace(larger, chain=chain)
    run = run_to_slip(drawn, step)
    found = numbers(run)
    if draw == 0 and larger.weakening_velocity:
        finer = apparent_friction(run_to_slip(drawn, run.numbers["step"] / 2.0))
        found["halved_mu_sapp"] = abs(finer - found["mu_sapp"])
    return point | found


def run_to_slip(larger: LargerChain, step: float) -> Any:
    """Run to the end of the first global slip; the paper's chain by its own solver,
    which is faster."""
    limit = longest_run(larger.chain) / 4.0
    if larger.weakening_velocity or larger.relaxation_time or larger.push_height:
        return simulate_larger(larger, limit, "global slip", step)
    return simulate(larger.chain, limit, "global slip")


def numbers(run: Record) -> dict[str, float]:
    """Numbers of a run that ends with its first global slip; NaN without one.

    events_counted is that of Fig. 13, mu_sapp Eq. 1. Of the events in which F_X falls
    by `DROP` or more, counted_over is the number in Fig. 13, and logged_over that in
    Fig. 13 as a logger at 1 kHz sees them.
    """
    slips = find_slips(run)
    friction = apparent_friction(run)
    if math.isnan(friction):
        return {"mu_sapp": friction}
    found = {"events_counted": len(find_precursors(slips)), "mu_sapp": friction}
    for name, table in {"counted": slips, "logged": as_logged(slips)}.items():
        large = table[table["load_before"] - table["load_after"] >= DROP]
        found[f"{name}_over_{DROP:g}N"] = len(find_precursors(large))
    return found


def as_logged(slips: pd.DataFrame) -> pd.DataFrame:
    """Slips, with those joined between which F_X rises for less than `SAMPLE`."""
    rest = slips["onset"] - slips["end"].shift(fill_value=-np.inf)
    joined = slips.groupby((rest >= SAMPLE).cumsum())
    return joined.agg(
        {
            "load_before": "first",
            "load_after": "last",
            "front": "max",
            "is_global": "any",
        }
    )


def medians_table(runs: pd.DataFrame) -> pd.DataFrame:
    """Medians over the runs of a point that have a global slip, of which there are
    `runs`: a row for each point."""
    of_point = runs.groupby(POINT, sort=False)
    medians = of_point.median()
    medians.insert(0, "runs", of_point["mu_sapp"].count())
    return medians.reset_index()
