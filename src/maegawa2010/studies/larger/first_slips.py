"""The larger chain before its first global slip: where creep runs away, and how many
events it has."""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from itertools import product
from typing import Any

import numpy as np
import pandas as pd

from maegawa2010.studies.members import chain_of, varied
from precursors.analysis.slips import find_precursors, find_slips
from precursors.analysis.summary import apparent_friction
from precursors.larger.chain import LargerChain, critical_length, weakening_velocity
from precursors.larger.simulate import simulate_larger
from precursors.model.chain import Chain, parse_theta
from precursors.model.statics import longest_run
from precursors.solver.run import Record
from precursors.solver.simulate import simulate
from precursors.support.compiled import untyped
from precursors.support.waiting import in_threads

# Of `simulate_larger`: half of it changes settled peaks by less than 1e-3.
STEP = 0.25
# Fall of F_X, over F_X, that ends smooth growth: creep that trembles lets it fall by
# less.
SEEN = 0.002
AXES = [
    "even_length",
    "relaxation_time",
    "push_height",
    "normal_load",
    "theta",
    "n_blocks",
]
POINT = ["study", *AXES, "weakening_velocity", "step"]


def points(
    slider: Mapping[str, Any], name: str, study: Mapping[str, Any]
) -> Iterator[dict[str, Any]]:
    """Every point of a study: a member (see `chain_of`) with the numbers of a
    `LargerChain`.

    `slider` has the arguments of `Chain.from_slider`. `study` has values of `AXES`, and
    perhaps a step. even_length is l_c/L of the slider with an even load, for which v_c
    is chosen; 0 is Coulomb friction.
    """
    axes = {"push_height": [0.0], "normal_load": [slider["normal_load"]], **study}
    for values in product(*(axes[axis] for axis in AXES)):
        point = {**slider, "study": name, **dict(zip(AXES, values, strict=True))}
        point["theta"] = parse_theta(point["theta"])
        point["weakening_velocity"] = weakening_velocity(
            Chain.from_slider(**slider), point["even_length"], point["relaxation_time"]
        )
        yield point | {"step": study.get("step", STEP)}


def larger_of(point: Mapping[str, Any], chain: Chain | None = None) -> LargerChain:
    """Larger chain of a point, of its own or another chain."""
    names = ("weakening_velocity", "relaxation_time", "push_height")
    numbers = {name: point[name] for name in names}
    return LargerChain(chain or chain_of(point), **numbers)


def larger_tables(
    slider: Mapping[str, Any], settings: Mapping[str, Any]
) -> dict[str, pd.DataFrame]:
    """First slips, and where creep runs away, by file name."""
    studies = settings["studies"].items()
    runs = [
        partial(run_draw, settings, point, draw)
        for name, study in studies
        for point in points(slider, name, study)
        for draw in range(study.get("runs", 1))
    ]
    creep = points(slider, "nucleation", settings["nucleation"])
    return {
        "larger": medians_table(in_all_threads(runs)),
        "larger_nucleation": in_all_threads([partial(run_creep, at) for at in creep]),
    }


def in_all_threads(tasks: Sequence[Callable[[], dict[str, Any]]]) -> pd.DataFrame:
    """Table of what tasks return."""
    rows = in_threads(tasks, untyped.config.NUMBA_NUM_THREADS)
    return varied(pd.DataFrame(rows))


def run_creep(point: Mapping[str, Any]) -> dict[str, Any]:
    """Length at which smooth growth ends: a row of larger_nucleation.csv.

    Creep of length l behind the drive needs F_X = mu_s W(l), W the cumulative normal
    load. So the load at which the first event begins gives the length that crept until
    then, if events in which F_X falls by less than `SEEN` are left out. Columns beside
    those of the point: critical_length and measured [L], and ratio, measured over
    theory.
    """
    larger = larger_of(point)
    chain = larger.chain
    theory = critical_length(larger) / chain.length
    places = np.linspace(0.0, 1.0, chain.n_blocks + 1)
    ends = np.append(0.0, np.cumsum(chain.strength))
    # The drive reaches mu_s F_Z in a tenth of the longest run.
    part = min(1.0, 1.3 * np.interp(theory, places, ends / ends[-1]))
    run = simulate_larger(larger, 0.1 * part * longest_run(chain), step=point["step"])
    slips = find_slips(run)
    falls = slips["load_after"] < (1.0 - SEEN) * slips["load_before"]
    measured = np.interp(slips["load_before"].iloc[falls.argmax()], ends, places)
    found = {"critical_length": theory, "measured": measured}
    return {**point, **found, "ratio": measured / theory}


def run_draw(
    settings: Mapping[str, Any], point: Mapping[str, Any], draw: int
) -> dict[str, Any]:
    """Run a chain to its first global slip: point, and `numbers` of the run.

    The normal loads have noise (relative), which depends on the seed, the number of
    blocks and the draw only.
    """
    chain = chain_of(point)
    random = np.random.default_rng([settings["seed"], chain.n_blocks, draw])
    noise = 1.0 + settings["noise"] * random.uniform(-1.0, 1.0, chain.n_blocks)
    drawn = larger_of(point, replace(chain, weights=chain.weights * noise))
    return {**point, **numbers(run_to_slip(drawn, point["step"]))}


def run_to_slip(larger: LargerChain, step: float) -> Any:
    """Run to the end of the first global slip; the paper's chain by its own solver,
    which is faster."""
    limit = longest_run(larger.chain) / 4.0
    if larger.weakening_velocity or larger.relaxation_time or larger.push_height:
        return simulate_larger(larger, limit, "global slip", step)
    return simulate(larger.chain, limit, "global slip")


def numbers(run: Record) -> dict[str, float]:
    """Numbers of a run that ends with its first global slip; NaN without one.

    events_counted is that of Fig. 13, mu_sapp Eq. 1.
    """
    friction = apparent_friction(run)
    if math.isnan(friction):
        return {"mu_sapp": friction}
    counted = len(find_precursors(find_slips(run)))
    return {"events_counted": counted, "mu_sapp": friction}


def medians_table(runs: pd.DataFrame) -> pd.DataFrame:
    """Medians over the runs of a point that have a global slip, of which there are
    `runs`: a row for each point."""
    of_point = runs.groupby([name for name in POINT if name in runs], sort=False)
    medians = of_point.median()
    medians.insert(0, "runs", of_point["mu_sapp"].count())
    return medians.reset_index()
