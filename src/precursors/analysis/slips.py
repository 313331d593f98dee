"""Slip events, precursors, the first global slip and mu_sapp (Eq. 1), under every
reading of these words."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import pandas as pd

from precursors.analysis.events import EVENT, slip_events
from precursors.analysis.slip_rows import (
    counted,
    first_global,
    up_to_first_global,
)
from precursors.solver.run import Record

# Without the numbers of the run and of its transitions.
COLUMNS = list(EVENT.names or ())[3:]
WITH_UNITS = {
    "onset": "onset_s",
    "end": "end_s",
    "load_before": "load_before_N",
    "load_after": "load_after_N",
    "largest_load": "largest_load_N",
}

GLOBAL_SLIPS = {
    "at once": "in which all blocks slide at the same instant",
    "each": "in which every block slides at some time",
}
FRONTS = {
    "front": "farthest block that slid",
    "n_slid": "number of blocks that slid",
    "n_simultaneous": "most blocks that slid at the same instant",
}


def find_slips(run: Record) -> pd.DataFrame:
    """Slip events of a run: maximal time intervals in which at least one block slides.

    Returns
    -------
    DataFrame
        One row per event: onset, end [s], load_before, load_after (F_X at onset and
        end), largest_load (F_X up to the onset) [N], front (farthest block that slid,
        1..N), n_slid (blocks that slid at some time), n_simultaneous (most blocks that
        slid at the same instant), is_global (all N at the same instant). The event that
        the end of the run cuts off has end and load_after NaN.
    """
    if not isinstance(run, Record):
        raise TypeError(
            f"slips are found in a Run or Record, but this is {type(run).__name__}"
        )
    return pd.DataFrame(slip_events([run]))[COLUMNS]


# Columns of `slip_table` that say which slider it was.
SLIDER_COLUMNS = ["theta", "n_blocks", "normal_load_N", "length_m", "mu_k"]


def slip_table(run: Record) -> pd.DataFrame:
    """Every slip event of a run, with units in the names of the columns.

    `counted` marks the rows of Fig. 13. theta, n_blocks, normal_load_N (F_Z), length_m
    (L) and mu_k say which slider it was, the same in every row; theta is NaN where it
    is not known.
    """
    slips = find_slips(run)
    return slips.rename(columns=WITH_UNITS).assign(
        counted=slips.index.isin(find_precursors(slips).index),
        theta=run.chain.theta,
        n_blocks=run.chain.n_blocks,
        normal_load_N=run.chain.normal_load,
        length_m=run.chain.length,
        mu_k=run.chain.mu_k,
    )


def find_precursors(slips: pd.DataFrame, short: str = "shorter") -> pd.DataFrame:
    """Events of Fig. 13: short ones left out, up to and including the first global
    slip.

    An event is short if its front is strictly less than the farthest front before it;
    equal ones are counted. `short` may name another reading, a key of SHORT_EVENTS.
    Without a global slip all events that are not short are returned.
    """
    if not isinstance(slips, pd.DataFrame) or not {"front", "is_global"} <= set(slips):
        given = (
            "another table" if isinstance(slips, pd.DataFrame) else type(slips).__name__
        )
        raise TypeError(
            f"precursors are found in the table of find_slips, but this is {given}"
        )
    until_global = up_to_first_global(slips)
    return until_global[counted(until_global["front"], short)]


@dataclass(frozen=True)
class Definition:
    """A reading of what the paper leaves open; the default is the one that gives its
    numbers.

    Attributes
    ----------
    global_slip : str or float
        A key of GLOBAL_SLIPS, or the drop of F_X [N] above which an event is a global
        slip.
    front : str
        The column of the slip table that is the length of an event, a key of FRONTS.
    short : str
        Which events Fig. 13 leaves out, a key of SHORT_EVENTS.
    """

    global_slip: str | float = "at once"
    front: str = "front"
    short: str = "shorter"

    @property
    def global_slip_text(self) -> str:
        """Which event is a global slip, in words."""
        if isinstance(self.global_slip, str):
            return GLOBAL_SLIPS[self.global_slip]
        return f"in which F_X drops by more than {self.global_slip:g} N"

    def read(self, slips: pd.DataFrame) -> pd.DataFrame:
        """A slip table with `front` and `is_global` in this reading."""
        if self.global_slip == "at once":
            is_global = slips["n_simultaneous"] == slips["n_blocks"]
        elif self.global_slip == "each":
            is_global = slips["n_slid"] == slips["n_blocks"]
        else:
            is_global = (
                slips["load_before_N"] - slips["load_after_N"] > self.global_slip
            )
        return slips.assign(front=slips[self.front], is_global=is_global)


OURS = Definition()


def apparent_friction(run: Record) -> float:
    """mu_sapp (Eq. 1): the largest F_X up to the first global slip over F_Z [1].

    NaN without a global slip.
    """
    slip = first_global_slip(slip_table(run))
    return slip.mu_sapp if slip else math.nan


@dataclass(frozen=True)
class FirstGlobalSlip:
    """The first global slip, which ends the loading, and its mu_sapp.

    Attributes
    ----------
    mu_sapp : float
        Apparent static friction coefficient [1].
    time : float
        Onset of the first global slip [s].
    event, events_counted : int
        Number of the first global slip among all events, from 1, and among those of
        Fig. 13.
    """

    mu_sapp: float
    time: float
    event: int
    events_counted: int


def first_global_slip(
    slips: pd.DataFrame, definition: Definition = OURS
) -> FirstGlobalSlip | None:
    """The first global slip in a table of `slip_table`, by a definition; None without
    one."""
    slips = definition.read(slips)
    first = first_global(slips)
    if first is None:
        return None
    slip = slips.iloc[first]
    return FirstGlobalSlip(
        mu_sapp=float(mu_sapp(slip["largest_load_N"], slip["normal_load_N"])),
        time=float(slip["onset_s"]),
        event=first + 1,
        events_counted=len(find_precursors(slips, definition.short)),
    )


def mu_sapp(largest_load: Any, normal_load: Any) -> Any:
    """Eq. 1: the largest F_X [N] up to the first global slip over F_Z [N].

    F_X is largest where block 1 begins to slide, or sticks after it slid backward:
    dF_X/dt = K (V - v_1). So the largest load is that of a transition, to within V.
    """
    return largest_load / normal_load
