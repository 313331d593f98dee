"""What every reading of "global slip", "short", "front" and theta gives beside the paper."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

import pandas as pd

from precursors.analysis.slips import (
    FRONTS,
    SHORT_EVENTS,
    Definition,
    apparent_friction,
    every_definition,
    find_slips,
)
from precursors.model.chain import Chain, parse_theta
from precursors.solver.run import Run
from precursors.solver.simulate import simulate

# The paper prints mu_sapp with two digits and says that it "appears to have" this value for all loadings.
LAST_DIGIT = 0.01
READING = ["degree", "global_slip", "short", "front"]


def definitions_table(
    slider: Mapping[str, Any],
    duration: float,
    degrees: Sequence[float | str],
    load_drops: Iterable[float],
    paper: Sequence[Mapping[str, float]],
) -> pd.DataFrame:
    """What every reading gives: one row per size of theta, sign of it and reading.

    Parameters
    ----------
    slider : mapping
        Arguments of `Chain.from_slider` but theta.
    duration : float
        Time to simulate [s].
    degrees : sequence
        Sizes of theta.
    load_drops : iterable of float
        Drops of F_X [N] above which an event is a global slip, as readings of it.
    paper : sequence of mapping
        The paper's events_kept and mu_sapp for theta < 0, theta = 0 and theta > 0.

    Notes
    -----
    Of the six numbers of a reading, `numbers_as_printed` counts those that equal the paper's after rounding
    to the digits that it prints, and `numbers_within_a_digit` those that are off by at most one in its last
    digit.
    """
    definitions = list(every_definition(load_drops))
    found: dict[float, list[dict[str, Any]]] = {}
    rows = []
    for degree in degrees:
        for sign, printed in zip((-1, 0, 1), paper, strict=True):
            theta = sign * parse_theta(degree)
            if theta not in found:
                run = simulate(Chain.from_slider(**{**slider, "theta": theta}), duration)
                found[theta] = list(readings(run, definitions))
            rows += [
                {"degree": degree, "theta": theta, **row, **compare(row, printed)} for row in found[theta]
            ]
    table = pd.DataFrame(rows)
    for kind in ("as_printed", "within_a_digit"):
        agree = table["events_kept_is_papers"].astype(int) + table[f"mu_sapp_is_papers_{kind}"]
        table[f"numbers_{kind}"] = agree.groupby([table[key].astype(str) for key in READING]).transform("sum")
    return table


def readings(run: Run, definitions: Iterable[Definition]) -> Iterator[dict[str, Any]]:
    """What each reading gives for a run; numbers are empty without a global slip in its sense."""
    slips = find_slips(run)
    for definition in definitions:
        largest, onset = (
            apparent_friction(run, slips, replace(definition, largest=largest)) for largest in (True, False)
        )
        yield {
            "global_slip": definition.global_slip_text,
            "short": SHORT_EVENTS[definition.short],
            "front": FRONTS[definition.front],
            "events_kept": largest.events_kept if largest else None,
            "mu_sapp": largest.mu_sapp if largest else None,
            "mu_sapp_at_onset": onset.mu_sapp if onset else None,
            "global_slip_time_s": onset.time if onset else None,
        }


def compare(row: Mapping[str, Any], printed: Mapping[str, float]) -> dict[str, Any]:
    """Set the paper's numbers beside those of a reading, and tell which agree."""
    kept, friction = printed.get("events_kept"), printed.get("mu_sapp")
    known = row["mu_sapp"] is not None and friction is not None
    return {
        "events_kept_paper": kept,
        "mu_sapp_paper": friction,
        "events_kept_is_papers": kept is not None and row["events_kept"] == kept,
        "mu_sapp_is_papers_as_printed": known and round(row["mu_sapp"], 2) == friction,
        "mu_sapp_is_papers_within_a_digit": known and abs(row["mu_sapp"] - friction) <= LAST_DIGIT,
    }
