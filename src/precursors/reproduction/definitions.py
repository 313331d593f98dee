"""What other readings of the paper's words give: one change at a time."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

import pandas as pd

from precursors.analysis.slips import (
    FRONTS,
    GLOBAL_SLIPS,
    SHORT_EVENTS,
    Definition,
    apparent_friction,
    slip_table,
)
from precursors.methods.columns import SWITCHING_RULES
from precursors.methods.march import march
from precursors.methods.rk4_located import run_located
from precursors.methods.switching import COULOMB
from precursors.model.chain import Chain, parse_theta
from precursors.solver.run import Record, Run
from precursors.solver.simulate import simulate

# The paper says that mu_sapp "appears to have" its value, which it prints with two
# digits.
LAST_DIGIT = 0.01
# The size of theta where it is that of the scenes.
OF_SCENES = "as in the scenes"
# Of the method for other rules of switching [s]; mu_sapp is right to 1e-5.
STEP = 1e-7
SIGNS = (-1, 0, 1)


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
    for changed, degree, rule, definition in readings(degrees, load_drops):
        reading = {
            "changed": changed,
            "degree": degree,
            "switching": rule,
            "global_slip": definition.global_slip_text,
            "short": SHORT_EVENTS[definition.short],
            "front": FRONTS[definition.front],
        }
        for sign, of_scene, printed in zip(SIGNS, runs, paper, strict=True):
            run: Record = of_scene
            theta = of_scene.chain.theta
            if degree != OF_SCENES:
                theta = sign * parse_theta(degree)
                run = simulate(
                    Chain.from_slider(**{**slider, "theta": theta}), duration
                )
            if rule != COULOMB:
                run = march(run_located, (), run.chain, duration, STEP, rule=rule).run
            found = apparent_friction(slip_table(run), definition)
            counted, friction = (
                (found.events_counted, found.mu_sapp) if found else (math.nan, math.nan)
            )
            agree = {
                "events_counted_is_papers": counted == printed.get("events_counted"),
                "mu_sapp_is_papers_within_a_digit": (
                    abs(friction - printed.get("mu_sapp", math.nan)) <= LAST_DIGIT
                ),
            }
            row = {
                **reading,
                "theta": theta,
                "events_counted": counted,
                "mu_sapp": friction,
            }
            rows.append(row | {"numbers_within_a_digit": sum(agree.values())})
    table = pd.DataFrame(rows)
    of_reading = table.groupby(table.index // len(SIGNS))
    return table.assign(
        numbers_within_a_digit=of_reading["numbers_within_a_digit"].transform("sum")
    )


def readings(
    degrees: Iterable[float | str], load_drops: Iterable[float]
) -> Iterator[tuple[str, float | str, str, Definition]]:
    """Our reading and those with one change: what is changed, size of theta, switching,
    definition."""
    ours = Definition()
    drops: list[str | float] = [*list(GLOBAL_SLIPS)[1:], *load_drops]
    yield "nothing", OF_SCENES, COULOMB, ours
    for definition in (replace(ours, global_slip=global_slip) for global_slip in drops):
        yield "global slip", OF_SCENES, COULOMB, definition
    for short in list(SHORT_EVENTS)[1:]:
        yield "short event", OF_SCENES, COULOMB, replace(ours, short=short)
    for front in list(FRONTS)[1:]:
        yield "length", OF_SCENES, COULOMB, replace(ours, front=front)
    for degree in degrees:
        yield "size of theta", degree, COULOMB, ours
    for rule in list(SWITCHING_RULES)[1:]:
        yield "switching", OF_SCENES, rule, ours
