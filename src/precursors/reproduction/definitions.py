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
from precursors.methods.fixed_step import march
from precursors.methods.rk4_located import run_located
from precursors.model.chain import Chain, parse_theta
from precursors.model.switching import COULOMB
from precursors.solver.run import Run
from precursors.solver.simulate import simulate

# The paper prints mu_sapp with two digits and says that it "appears to have" this value for all loadings.
DIGITS, LAST_DIGIT = 2, 0.01
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

    Of the six numbers of a reading, `numbers_as_printed` counts those that are the paper's when rounded to
    its digits, and `numbers_within_a_digit` those that differ by at most one unit of its last digit.

    Parameters
    ----------
    runs : sequence of Run
        The scenes with theta < 0, theta = 0 and theta > 0.
    slider, duration : mapping, float
        Arguments of `Chain.from_slider` but theta, and time to simulate [s], for other sizes of theta.
    degrees : sequence
        Other sizes of theta.
    load_drops : iterable of float
        Drops of F_X [N]; an event with a larger drop is a global slip in this reading.
    paper : sequence of mapping
        The paper's events_counted and mu_sapp in the order of the runs, as far as it has them.
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
            run, theta = of_scene, of_scene.slider["theta"] if of_scene.slider else math.nan
            if degree != OF_SCENES:
                theta = sign * parse_theta(degree)
                run = simulate(Chain.from_slider(**{**slider, "theta": theta}), duration)
            if rule != COULOMB:
                run = march(run_located, (), run.chain, duration, STEP, rule=rule).run
            papers = {f"{name}_paper": printed.get(name) for name in ("events_counted", "mu_sapp")}
            rows.append({**reading, "theta": theta, **numbers(run, definition), **papers})
    return with_agreement(pd.DataFrame(rows))


def readings(
    degrees: Iterable[float | str], load_drops: Iterable[float]
) -> Iterator[tuple[str, float | str, str, Definition]]:
    """Our reading and those with one change: what is changed, size of theta, switching, definition."""
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


def numbers(run: Run, definition: Definition) -> dict[str, float | None]:
    """What a reading gives for a run; empty where it has no global slip in this sense."""
    slips = slip_table(run)
    largest = apparent_friction(slips, definition)
    onset = apparent_friction(slips, replace(definition, largest=False))
    return {
        "events_counted": largest.events_counted if largest else None,
        "mu_sapp": largest.mu_sapp if largest else None,
        "mu_sapp_at_onset": onset.mu_sapp if onset else None,
        "global_slip_time_s": onset.time if onset else None,
    }


def with_agreement(table: pd.DataFrame) -> pd.DataFrame:
    """The table with columns that say which numbers are the paper's, and how many of the six of a reading."""
    friction, papers = (table[name].astype(float) for name in ("mu_sapp", "mu_sapp_paper"))
    table["events_counted_is_papers"] = table["events_counted"].astype(float) == table["events_counted_paper"]
    table["mu_sapp_is_papers_as_printed"] = friction.round(DIGITS) == papers
    table["mu_sapp_is_papers_within_a_digit"] = (friction - papers).abs() <= LAST_DIGIT
    reading = table.index // len(SIGNS)
    for kind in ("as_printed", "within_a_digit"):
        agree = table["events_counted_is_papers"].astype(int) + table[f"mu_sapp_is_papers_{kind}"]
        table[f"numbers_{kind}"] = agree.groupby(reading).transform("sum")
    return table
