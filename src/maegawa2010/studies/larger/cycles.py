"""Stick-slip of the larger chain after its first slips: the coefficient into which it
settles, beside its law."""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np
import pandas as pd

from maegawa2010.studies.larger.first_slips import larger_of, points
from maegawa2010.studies.members import LOADINGS, Study, gather
from precursors.larger.chain import LargerChain, critical_length, weakening_velocity
from precursors.larger.law import Law
from precursors.larger.settled import settled
from precursors.larger.simulate import simulate_larger
from precursors.model.chain import Chain, FloatArray
from precursors.solver.run import Record
from precursors.solver.simulate import TransitionLimitError
from precursors.support.waiting import in_threads

# Of the straight lines from which the net forces of a strained start are made.
NODES = 8
# Ranges of the numbers of chains that are drawn: l_c/L for an even load, t_v [s], theta
# or another loading, and factors of the slider's own.
DRAWN = {
    "even_length": (0.08, 0.4),
    "relaxation_time": (1e-5, 2.5e-4),
    "theta": (-0.9, 0.9),
    "normal_load": (0.25, 1.0),
    "drive_stiffness": (0.3, 4.0),
    "mu_k": (0.6, 1.3),
}
CHANGE = 1e-3  # of a peak [F_Z], from which the change after it says how it alternates


def settled_study(slider: Mapping[str, Any], settings: Mapping[str, Any]) -> Study:
    """Chains within the limits of the law, each from several pasts.

    A past is noise in the normal loads and strain at the start. `drawn` chains have
    numbers within `DRAWN` and one past each, its second number being the most.
    """
    members = [
        {**point, "past": i, "noise": noise, "strain": strain}
        for name, study in settings["studies"].items()
        for point in points(slider, name, study)
        if law_or_none(larger_of(point))
        for i, (noise, strain) in enumerate(study["pasts"])
    ]
    random = np.random.default_rng(settings["seed"])
    drawn = draw_points(slider, random)
    for study in settings["drawn"]:
        for i in range(study["chains"]):
            point = next(drawn) | {name: study[name] for name in ("n_blocks", "step")}
            strain = random.uniform()
            members.append({**point, "past": i, "noise": 1e-3, "strain": strain})
    table = pd.DataFrame(members).fillna({"loading": "linear"})
    # A slower drive brings its slips later.
    slower = slider["drive_stiffness"] / table["drive_stiffness"]
    return Study(table.assign(duration=settings["duration"] * slower), settings["seed"])


def draw_points(
    slider: Mapping[str, Any], random: np.random.Generator
) -> Iterator[dict[str, Any]]:
    """Points like those of `points`, drawn at random within the limits of the law."""
    while True:
        values = {name: random.uniform(*ends) for name, ends in DRAWN.items()}
        for name in ("normal_load", "drive_stiffness", "mu_k"):
            values[name] *= slider[name]
        point = {**slider, **values, "study": "drawn", "push_height": 0.0}
        point["loading"] = random.choice(["linear", *LOADINGS])
        own = {name: point[name] for name in slider}
        point["weakening_velocity"] = weakening_velocity(
            Chain.from_slider(**own), point["even_length"], point["relaxation_time"]
        )
        if law_or_none(larger_of(point | {"n_blocks": 50})):
            yield point


def law_or_none(larger: LargerChain) -> Law | None:
    """Law of a chain; none outside its limits."""
    try:
        return Law(larger)
    except ValueError:
        return None


def run_settled(study: Study) -> pd.DataFrame:
    """Run every member until it settles: the members, each with `run_past`."""
    members = study.members.to_dict("records")
    rows = in_threads([partial(run_past, study.seed, at) for at in members])
    return study.members.join(pd.DataFrame(rows, study.members.index))


def run_past(seed: int, member: Mapping[Any, Any]) -> dict[str, float]:
    """Run a member until it settles, or as far as the limit of work lets it: what
    `settled` finds, with l_c/L and, for the peaks, their `slope_of`."""
    random = np.random.default_rng([seed, member["past"]])
    past = (member["noise"], member["strain"])
    larger = larger_of(member)
    nucleus = critical_length(larger) / larger.chain.length
    chain, forces = with_past(larger.chain, past, random)
    run: Record
    try:
        run = simulate_larger(
            replace(larger, chain=chain),
            member["duration"],
            "settled",
            member["step"],
            start_forces=forces,
        )
    except TransitionLimitError as limit:
        run = limit.run
    found = settled(run, nucleus)
    slope = slope_of(found.pop("peaks"))
    return {"critical_length": nucleus, **found, "slope": slope}


def with_past(
    chain: Chain, past: tuple[float, float], random: np.random.Generator
) -> tuple[Chain, FloatArray]:
    """A chain with noise in its normal loads, whose sum stays, and spring forces at
    which it rests strained.

    `past` is the noise, relative to each load, and the largest net force on a block,
    relative to mu_s w. Net forces are straight lines between a few nodes, so that
    chains of any number of blocks have the same.
    """
    noise, strain = past
    weights = chain.weights
    places = np.linspace(0.0, 1.0, len(weights))
    net = np.interp(places, np.linspace(0.0, 1.0, NODES), random.uniform(-1, 1, NODES))
    net -= (net @ weights) / weights.sum()  # F_X is 0
    net *= strain * chain.strength / abs(net).max()
    noisy = weights * (1.0 + noise * random.uniform(-1.0, 1.0, len(weights)))
    noisy *= weights.sum() / noisy.sum()
    forces = np.append(0.0, -np.cumsum(net)[:-1])
    return replace(chain, weights=noisy), forces


def slope_of(peaks: FloatArray) -> float:
    """Median ratio of the changes of successive peaks; NaN if they hardly change."""
    changes = np.diff(peaks)
    is_large = abs(changes[:-1]) > CHANGE
    ratios = changes[1:][is_large] / changes[:-1][is_large]
    return float(np.median(ratios)) if len(ratios) else np.nan


def settled_table(
    chunks: Iterable[pd.DataFrame], slider: Mapping[str, Any]
) -> pd.DataFrame:
    """All runs of the study, beside the law."""
    runs = gather(chunks).drop(columns=["duration", "push_height"], errors="ignore")
    return beside_law(runs, slider)


def beside_law(runs: pd.DataFrame, slider: Mapping[str, Any]) -> pd.DataFrame:
    """Runs with the law of their chains: law_coefficient with the precursors of the
    run, law_slope, and with nothing counted predicted_coefficient and
    predicted_precursors of the cycle from rest, and the `possible` numbers of them."""
    every = runs.assign(
        push_height=0.0, **{name: slider[name] for name in set(slider) - set(runs)}
    )
    rows: list[Any] = every.to_dict("records")
    chains = [larger_of(row) for row in rows]
    predictions = {}
    for larger in set(chains):
        law = Law(larger)
        cycle = law.cycle(law.rest)
        predictions[larger] = {
            "law_slope": law.fixed_point().slope,
            "predicted_coefficient": cycle.coefficient,
            "predicted_precursors": cycle.precursors,
            "possible": " ".join(f"{n:g}" for n in law.possible),
            "law": law,
        }
    beside = pd.DataFrame([predictions[larger] for larger in chains], runs.index)
    counted = [
        law.fixed_point(n).coefficient
        for law, n in zip(beside.pop("law"), runs["precursors"], strict=True)
    ]
    return runs.assign(law_coefficient=counted, **beside)
