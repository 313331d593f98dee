"""Readings of terms that the paper leaves undefined: ours, those that change one term,
and the numbers that each reading gives."""

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from maegawa2010 import printed
from precursors.analysis.slips import slip_table, until_global
from precursors.analysis.summary import summary_of
from precursors.model.chain import Chain, parse_theta
from precursors.solver import plain
from precursors.solver.run import Record, Run
from precursors.solver.simulate import MAX_TRANSITIONS, simulate

GLOBAL_SLIPS = {
    "at once": "in which all blocks slide at the same instant",
    "each": "in which every block slides at some time",
}
FRONTS = {
    "front": "farthest block that slid",
    "n_slid": "number of blocks that slid",
    "n_simultaneous": "most blocks that slid at the same instant",
}
SHORT_EVENTS = {
    "shorter": "shorter than one before it",
    "not longer": "not longer than all before it",
    "shorter than the last": "shorter than the one just before it",
}
# Stands for the values of theta of the scenes.
OF_SCENES = "scenes"
SIGNS = (-1, 0, 1)
COULOMB = "static"
SWITCHING = {
    COULOMB: "sticks if |F| <= mu_s w",
    "kinetic": "sticks if |F| <= mu_k w",
    "forward_only": "slides forward only",
}


@dataclass(frozen=True)
class Reading:
    """A reading of the paper's words; the default is ours, which gives the paper's numbers.

    Attributes
    ----------
    changed, reading : str
        The attribute below that differs from our reading, and how it differs.
    global_slip : str or float
        A key of GLOBAL_SLIPS, or a drop of F_X [N]: an event with a larger drop is a
        global slip.
    short : str
        Which events Fig. 13 leaves out, a key of SHORT_EVENTS.
    front : str
        The column of the slip table used as the length of an event, a key of FRONTS.
    degree : float or str
        The absolute value of theta.
    switching : str
        When a block sticks, a key of SWITCHING.
    """

    changed: str = "nothing"
    reading: str = "our reading"
    global_slip: str | float = "at once"
    short: str = "shorter"
    front: str = "front"
    degree: float | str = OF_SCENES
    switching: str = COULOMB

    def is_global(self, slips: pd.DataFrame) -> Any:
        """Which events are global slips."""
        if self.global_slip == "at once":
            return slips["is_global"]
        if self.global_slip == "each":
            return slips["n_slid"] == slips["n_blocks"]
        return slips["load_before_N"] - slips["load_after_N"] > self.global_slip

    def is_short(self, slips: pd.DataFrame) -> NDArray[np.bool_]:
        """Which events are short."""
        front = slips[self.front].to_numpy()
        farthest = np.maximum.accumulate(front)
        if self.short == "shorter":
            return front < farthest
        if self.short == "not longer":
            return np.diff(farthest, prepend=0) == 0
        return np.diff(front, prepend=0) < 0

    def read(self, slips: pd.DataFrame) -> pd.DataFrame:
        """A slip table with the columns `is_global` and `counted` of this reading."""
        is_global = self.is_global(slips)
        is_counted = until_global(is_global) & ~self.is_short(slips)
        return slips.assign(is_global=is_global, counted=is_counted)


def readings(
    degrees: Iterable[float | str], load_drops: Iterable[float]
) -> Iterator[Reading]:
    """Yield our reading, then those with one change."""
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
    """One row for each reading and loading; the first three rows are our reading.

    `numbers_within_a_digit` counts how many of the six numbers of a reading differ from
    the paper's by at most one unit of its last digit. Without a global slip the numbers
    are NaN.

    Parameters
    ----------
    runs : sequence of Run
        The scenes with theta < 0, theta = 0 and theta > 0.
    slider, duration : mapping, float
        For other values of theta: arguments of `Chain.from_slider` except theta, and
        the time to simulate [s].
    degrees : sequence
        Other absolute values of theta.
    load_drops : iterable of float
        Drops of F_X [N]; an event with a larger drop is a global slip in this reading.
    paper : sequence of mapping
        The paper's events_counted and mu_sapp, where it prints them, in the order of
        the runs.
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
    """Run a chain up to its first global slip with another rule for sticking."""
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
    run: Record, reading: Reading, of_paper: Mapping[str, float]
) -> dict[str, Any]:
    """Number of events and mu_sapp of a run, and how many of these two agree with the
    paper (mu_sapp to one unit of its last digit)."""
    summary = summary_of(reading.read(slip_table(run)))
    counted = summary.events_counted if summary.reached else math.nan
    off = abs(summary.mu_sapp - of_paper.get("mu_sapp", math.nan))
    agree = [counted == of_paper.get("events_counted"), off <= printed.LAST_DIGIT]
    return {
        "events_counted": counted,
        "mu_sapp": summary.mu_sapp,
        "numbers_within_a_digit": sum(agree),
    }
