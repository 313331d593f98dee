"""Other readings of the paper's words, one change at a time, and what they give."""

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from typing import Any

import numpy as np
import pandas as pd

from maegawa2010 import printed
from maegawa2010.paper.readings import (
    FRONTS,
    GLOBAL_SLIPS,
    SHORT_EVENTS,
    Definition,
)
from precursors.analysis.slips import slip_table
from precursors.analysis.summary import summary_of
from precursors.model.chain import Chain, parse_theta
from precursors.solver import plain
from precursors.solver.run import Record, Run
from precursors.solver.simulate import MAX_TRANSITIONS, simulate

# The size of theta where it is that of the scenes.
OF_SCENES = "scenes"
SIGNS = (-1, 0, 1)
COULOMB = "static"
SWITCHING = {
    COULOMB: "sticks if |F| <= mu_s w",
    "kinetic": "sticks if |F| <= mu_k w",
    "forward_only": "slides forward only",
}


@dataclass(frozen=True)
class Reading(Definition):
    """A reading of the paper's words, by default ours.

    `changed` names the one column of the table that is not as in ours, and `reading`
    says how.
    """

    changed: str = "nothing"
    reading: str = "our reading"
    degree: float | str = OF_SCENES
    switching: str = COULOMB


def readings(
    degrees: Iterable[float | str], load_drops: Iterable[float]
) -> Iterator[Reading]:
    """Our reading and those with one change."""
    drops = {drop: f"in which F_X drops by more than {drop:g} N" for drop in load_drops}
    choices: dict[str, tuple[str, dict[Any, Any]]] = {
        "global_slip": ("global slip", GLOBAL_SLIPS | drops),
        "short": ("short event", SHORT_EVENTS),
        "front": ("length", FRONTS),
        "degree": ("size of theta", {degree: degree for degree in degrees}),
        "switching": ("switching", SWITCHING),
    }
    ours = Reading()
    yield ours
    for changed, (words, values) in choices.items():
        for value, text in values.items():
            if value != getattr(ours, changed):
                change = {changed: value, "reading": f"{words}: {text}"}
                yield replace(ours, changed=changed, **change)


def definitions_table(
    runs: Sequence[Run],
    slider: Mapping[str, Any],
    duration: float,
    degrees: Sequence[float | str],
    load_drops: Iterable[float],
    paper: Sequence[Mapping[str, float]],
) -> pd.DataFrame:
    """One row for each reading and loading; the first three rows are ours.

    Of the six numbers of a reading, `numbers_within_a_digit` counts those that differ
    from the paper's by at most one unit of its last digit. A reading that has no global
    slip has no numbers.

    Parameters
    ----------
    runs : sequence of Run
        The scenes with theta < 0, theta = 0 and theta > 0.
    slider, duration : mapping, float
        Arguments of `Chain.from_slider` but theta, and time to simulate [s], for other
        sizes of theta.
    degrees : sequence
        Other sizes of theta.
    load_drops : iterable of float
        Drops of F_X [N]; an event with a larger drop is a global slip in this reading.
    paper : sequence of mapping
        The paper's events_counted and mu_sapp in the order of the runs, as far as it
        has them.
    """
    rows = []
    for reading in readings(degrees, load_drops):
        for sign, of_scene, of_paper in zip(SIGNS, runs, paper, strict=True):
            chain = of_scene.chain
            if reading.degree != OF_SCENES:
                theta = sign * parse_theta(reading.degree)
                chain = Chain.from_slider(**{**slider, "theta": theta})
            run: Record = of_scene
            if reading.switching != COULOMB:
                run = run_switching(chain, duration, reading.switching)
            elif chain is not of_scene.chain:
                run = simulate(chain, duration)
            row = asdict(reading) | {"theta": chain.theta}
            rows.append(row | numbers(run, reading, of_paper))
    table = pd.DataFrame(rows)
    of_reading = table.groupby(table.index // len(SIGNS))
    within = of_reading["numbers_within_a_digit"].transform("sum")
    return table.assign(numbers_within_a_digit=within)


def run_switching(chain: Chain, duration: float, rule: str) -> Record:
    """Run a chain up to its first global slip under another rule of switching."""
    sticks_within = {
        "kinetic": chain.kinetic_friction,
        "forward_only": np.full(chain.n_blocks, np.inf),
    }
    switching = plain.Switching(sticks_within[rule], rule != "forward_only")
    rest = np.zeros(chain.n_blocks)
    rows, end = plain.find_transitions(
        chain,
        plain.at_start(chain, rest, rest),
        duration,
        until_global=True,
        most=MAX_TRANSITIONS,
        switching=switching,
    )
    time, _, block, mode, load = np.array(rows, dtype=float).reshape(-1, 5).T
    return Record.from_columns(chain, end, time, block, mode, load)


def numbers(
    run: Record, definition: Definition, of_paper: Mapping[str, float]
) -> dict[str, Any]:
    """Both numbers of a run, and how many of them are the paper's: mu_sapp to a unit of
    its last digit."""
    found = summary_of(definition.read(slip_table(run)))
    counted = found.events_counted if found.reached else math.nan
    off = abs(found.mu_sapp - of_paper.get("mu_sapp", math.nan))
    agree = [counted == of_paper.get("events_counted"), off <= printed.LAST_DIGIT]
    return {
        "events_counted": counted,
        "mu_sapp": found.mu_sapp,
        "numbers_within_a_digit": sum(agree),
    }
