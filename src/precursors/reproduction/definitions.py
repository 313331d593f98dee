"""What every reading of "global slip", "short event", "length", theta and the rule of switching gives."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import product
from typing import Any

import pandas as pd

from precursors.analysis.slips import (
    FRONTS,
    SHORT_EVENTS,
    Definition,
    apparent_friction,
    every_definition,
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
READING = ["degree", "switching", "global_slip", "short", "front"]
# Of the method for other rules of switching [s]; mu_sapp is right to 1e-5.
STEP = 1e-7


def definitions_table(
    slider: Mapping[str, Any],
    duration: float,
    degrees: Sequence[float | str],
    load_drops: Iterable[float],
    paper: Sequence[Mapping[str, float]],
) -> pd.DataFrame:
    """One row for each size of theta, sign of theta, rule of switching and reading.

    Parameters
    ----------
    slider : mapping
        Arguments of `Chain.from_slider` but theta.
    duration : float
        Time to simulate [s].
    degrees : sequence
        Sizes of theta.
    load_drops : iterable of float
        Drops of F_X [N]; an event with a larger drop is a global slip in this reading.
    paper : sequence of mapping
        The paper's events_counted and mu_sapp for theta < 0, theta = 0 and theta > 0, as far as it has them.

    Notes
    -----
    Of the six numbers of a reading, `numbers_as_printed` counts those that are the paper's when rounded to
    its digits, and `numbers_within_a_digit` those that differ by at most one unit of its last digit.
    """
    definitions = list(every_definition(load_drops))
    found: dict[tuple[str, float], list[dict[str, Any]]] = {}
    rows = []
    for rule, degree in product(SWITCHING_RULES, degrees):
        for sign, printed in zip((-1, 0, 1), paper, strict=True):
            theta = sign * parse_theta(degree)
            if (rule, theta) not in found:
                run = solve(Chain.from_slider(**{**slider, "theta": theta}), duration, rule)
                found[rule, theta] = list(readings(run, definitions))
            papers = {f"{name}_paper": printed.get(name) for name in ("events_counted", "mu_sapp")}
            first = {"degree": degree, "switching": rule, "theta": theta}
            rows += [{**first, **row, **papers} for row in found[rule, theta]]
    return compared(pd.DataFrame(rows))


def solve(chain: Chain, duration: float, rule: str) -> Run:
    """Run a chain with a rule of switching: exactly, or by RK4 with located transitions."""
    if rule == COULOMB:
        return simulate(chain, duration)
    return march(run_located, (), chain, duration, STEP, rule=rule).run


def readings(run: Run, definitions: Iterable[Definition]) -> Iterator[dict[str, Any]]:
    """What each reading gives for a run; empty where it has no global slip in this sense."""
    slips = slip_table(run)
    for definition in definitions:
        largest = apparent_friction(slips, definition)
        onset = apparent_friction(slips, replace(definition, largest=False))
        yield {
            "global_slip": definition.global_slip_text,
            "short": SHORT_EVENTS[definition.short],
            "front": FRONTS[definition.front],
            "events_counted": largest.events_counted if largest else None,
            "mu_sapp": largest.mu_sapp if largest else None,
            "mu_sapp_at_onset": onset.mu_sapp if onset else None,
            "global_slip_time_s": onset.time if onset else None,
        }


def compared(table: pd.DataFrame) -> pd.DataFrame:
    """The table with columns that say which numbers are the paper's, and how many of the six of a reading."""
    friction, papers = (table[name].astype(float) for name in ("mu_sapp", "mu_sapp_paper"))
    table["events_counted_is_papers"] = table["events_counted"].astype(float) == table["events_counted_paper"]
    table["mu_sapp_is_papers_as_printed"] = friction.round(DIGITS) == papers
    table["mu_sapp_is_papers_within_a_digit"] = (friction - papers).abs() <= LAST_DIGIT
    reading = [table[name].astype(str) for name in READING]
    for kind in ("as_printed", "within_a_digit"):
        agree = table["events_counted_is_papers"].astype(int) + table[f"mu_sapp_is_papers_{kind}"]
        table[f"numbers_{kind}"] = agree.groupby(reading).transform("sum")
    return table
