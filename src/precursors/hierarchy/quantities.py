"""What one may ask of a scene, up to and including its first global slip."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd

from precursors.analysis.slip_rows import first_global
from precursors.analysis.slips import find_precursors
from precursors.model.chain import Chain, FloatArray, require_plain
from precursors.model.scene_models import (
    EVENTS_KEPT,
    FIRST_LOAD,
    FRONT_LOADS,
    LOAD_BOUND,
    MU_SAPP,
    SLIP_DURATION,
    WAVEFORM,
)


@dataclass(frozen=True)
class Quantity:
    """A quantity that models answer: its key in the table, what it is, and its unit."""

    name: str
    label: str
    unit: str


QUANTITIES = {
    quantity.name: quantity
    for quantity in (
        Quantity(LOAD_BOUND, "largest load of any state of rest (Eq. 13)", "N"),
        Quantity(FIRST_LOAD, "load of the first precursor", "N"),
        Quantity(EVENTS_KEPT, "number of events kept (Fig. 13)", "1"),
        Quantity(MU_SAPP, "apparent static friction coefficient (Eq. 1)", "1"),
        # One value for each n = 1..N: F_X at the onset of the first event whose front reaches block n.
        Quantity(FRONT_LOADS, "load at which the front first reaches each block", "N"),
        Quantity(SLIP_DURATION, "duration of the first global slip", "s"),
        # Rows of time [s] and F_X [N]; straight lines between them draw the load.
        Quantity(WAVEFORM, "tangential load over time", "N"),
    )
}


@dataclass(frozen=True)
class Model:
    """A rung of the ladder of models: a row of `MODELS`.

    Attributes
    ----------
    name : str
        The word after `model:` in a scene.
    label : str
        Name in tables and figures.
    answers : mapping
        From the name of each quantity that the model gives to the function that computes it.
    prepare : callable
        What the quantities are computed from, from the chain: its run, its events, or the chain itself.
    """

    name: str
    label: str
    answers: Mapping[str, Callable[[Any], Any]]
    prepare: Callable[[Chain], Any]

    @property
    def quantities(self) -> tuple[str, ...]:
        """Names of the quantities that the model can answer."""
        return tuple(self.answers)

    def answer(self, chain: Chain, quantities: Iterable[str] | None = None) -> dict[str, Any]:
        """Answer the quantities asked for, by default all that the model can; nothing else is computed.

        Raises
        ------
        ValueError
            If a quantity is not one that this model can answer, or the chain is none that it applies to.
        """
        asked = list(self.quantities if quantities is None else quantities)
        unknown = [name for name in asked if name not in self.answers]
        if unknown:
            raise ValueError(
                f"model {self.name!r} does not answer {unknown[0]!r}: allowed are {', '.join(self.answers)}"
            )
        if not asked:
            return {}
        basis = self.prepare(chain)
        return {name: self.answers[name](basis) for name in asked}


def plain(chain: Chain) -> Chain:
    """The chain itself, refused where it is more than the paper's."""
    require_plain(chain)
    return chain


def first_load(slips: pd.DataFrame) -> float:
    """F_X at the onset of the first event [N]."""
    return float(slips["load_before"].iloc[0]) if len(slips) else np.nan


def events_kept(slips: pd.DataFrame) -> float:
    """Number of events of Fig. 13; NaN without a global slip."""
    return float(len(find_precursors(slips))) if first_global(slips) is not None else np.nan


def front_loads(slips: pd.DataFrame, n_blocks: int) -> FloatArray:
    """F_X at the onset of the first event whose front reaches block n = 1..N or beyond [N]; NaN if none."""
    farthest = slips["front"].cummax().to_numpy()
    event = np.searchsorted(farthest, np.arange(1, n_blocks + 1))
    loads = np.append(slips["load_before"].to_numpy(), np.nan)
    return loads[event]


def slip_duration(slips: pd.DataFrame) -> float:
    """Duration of the first global slip [s]; NaN without one."""
    first = first_global(slips)
    if first is None:
        return np.nan
    event = slips.iloc[first]
    return float(event["end"] - event["onset"])
