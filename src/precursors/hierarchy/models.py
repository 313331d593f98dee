"""The models, from the smallest to the largest, and the quantities that each of them
answers."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import partial
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from precursors.analysis.events import slip_events
from precursors.analysis.slip_rows import counted
from precursors.analysis.slips import mu_sapp
from precursors.hierarchy import rigid, statics
from precursors.hierarchy.quasistatic import (
    ENERGY_CONSERVED,
    OVERDAMPED,
    quasistatic_slips,
)
from precursors.model.chain import Chain, FloatArray
from precursors.model.scenes import PAPERS_MODEL
from precursors.model.statics import load_bound
from precursors.solver.simulate import simulate

# Longest run, in units of the time in which the drive reaches mu_s F_Z against all
# springs in a row.
LIMIT = 10.0
# What one may ask of a chain, up to and including its first global slip, and its unit.
UNITS = {
    "load_bound": "N",  # largest load of any state of rest (Eq. 13)
    "first_load": "N",  # load at the onset of the first event
    "events_counted": "1",  # number of events counted in Fig. 13
    "mu_sapp": "1",  # apparent static friction coefficient (Eq. 1)
    "front_loads": "N",  # load at which the front first reaches each block 1..N
    "slip_duration": "s",  # of the first global slip
    "waveform": "N",  # rows of time [s] and load [N], with straight lines between them
}


@dataclass(frozen=True)
class Model:
    """A model of the table: its name in figures, and its answers by quantity from what
    `prepare` returns."""

    label: str
    answers: Mapping[str, Callable[[Any], Any]]
    prepare: Callable[[Any], Any] = field(default=lambda chain: chain)

    def ask(self, chain: Chain) -> dict[str, Any]:
        """All answers about a chain, by quantity."""
        prepared = self.prepare(chain)
        return {quantity: answer(prepared) for quantity, answer in self.answers.items()}


@dataclass(frozen=True, eq=False)
class FirstLoading:
    """A chain up to the end of its first global slip, or to where it is given up.

    `slips` have the columns of `find_slips`. `waveform` is time [s] and load [N] at the
    start and at each transition.
    """

    chain: Chain
    slips: NDArray[np.void]
    waveform: FloatArray = field(default_factory=lambda: np.empty((0, 2)))

    @property
    def global_slip(self) -> NDArray[np.void]:
        """The first global slip, in an array of one row, or of none."""
        return self.slips[self.slips["is_global"]]


def move(chain: Chain) -> FirstLoading:
    """Follow a chain through time to the end of its first global slip."""
    run = simulate(chain, longest_run(chain), until="global slip")
    times = run.transitions["time"]
    loads = run.transitions["tangential_load"]
    waveform = np.column_stack([np.append(0.0, times), np.append(0.0, loads)])
    return FirstLoading(chain, slip_events([run]), waveform)


def longest_run(chain: Chain) -> float:
    """Time [s] after which a run is given up that has had no global slip."""
    compliance = 1.0 / chain.drive_stiffness + (chain.n_blocks - 1) / chain.stiffness
    return LIMIT * chain.mu_s * chain.normal_load * compliance / chain.drive_velocity


def move_without_inertia(
    chain: Chain, overshoot: float = ENERGY_CONSERVED
) -> FirstLoading:
    """Follow a quasi-static chain to its first global slip."""
    return FirstLoading(chain, quasistatic_slips(chain, overshoot))


def front_loads(motion: FirstLoading) -> FloatArray:
    """F_X at the onset of the first event whose front reaches block 1..N or beyond [N];
    NaN if none."""
    farthest = np.maximum.accumulate(motion.slips["front"])
    event = np.searchsorted(farthest, np.arange(1, motion.chain.n_blocks + 1))
    return np.append(motion.slips["load_before"], np.nan)[event]


def apparent_friction(motion: FirstLoading) -> float:
    """mu_sapp (Eq. 1); NaN without a global slip."""
    loads = motion.global_slip["largest_load"]
    return float(mu_sapp(loads[0], motion.chain.normal_load)) if len(loads) else np.nan


def slip_duration(motion: FirstLoading) -> float:
    """Duration of the first global slip [s]; NaN without one."""
    slip = motion.global_slip
    return float(slip["end"][0] - slip["onset"][0]) if len(slip) else np.nan


def events_counted(motion: FirstLoading) -> float:
    """Number of events counted in Fig. 13; NaN without a global slip."""
    n_counted = np.count_nonzero(counted(motion.slips["front"]))
    return float(n_counted) if len(motion.global_slip) else np.nan


_EVENTS: dict[str, Callable[[FirstLoading], Any]] = {
    "first_load": lambda motion: float(motion.slips["load_before"][0]),
    "events_counted": events_counted,
    "mu_sapp": apparent_friction,
    "front_loads": front_loads,
}
_MOTION = _EVENTS | {
    "slip_duration": slip_duration,
    "waveform": lambda motion: motion.waveform,
}

# From the smallest to the largest; the key is the word after `model:` in a scene.
MODELS: dict[str, Model] = {
    "statics": Model(
        "statics",
        {"load_bound": load_bound, "first_load": statics.first_precursor_load},
    ),
    "law": Model(
        "front law",
        {
            "front_loads": statics.front_load_law,
            "mu_sapp": statics.apparent_friction_law,
        },
    ),
    "rigid": Model("rigid slider", rigid.ANSWERS),
    "overdamped": Model(
        "overdamped chain", _EVENTS, partial(move_without_inertia, overshoot=OVERDAMPED)
    ),
    "quasistatic": Model("quasi-static chain", _EVENTS, move_without_inertia),
    PAPERS_MODEL: Model("paper's chain", _MOTION, move),
}


def scene_answers(slider: Mapping[str, Any], model: str) -> pd.DataFrame:
    """Ask a model all that it answers about a slider, up to the end of the first global
    slip.

    Returns
    -------
    DataFrame
        One row per number: model, quantity, value and its unit; block (1..N) for the
        load at which the front first reaches each block; time_s [s] for the tangential
        load over time.
    """
    tables = []
    for quantity, answer in MODELS[model].ask(Chain.from_slider(**slider)).items():
        value = np.asarray(answer)
        table = pd.DataFrame(
            {"value": np.atleast_1d(value if value.ndim < 2 else value[:, 1])}
        )
        table["block"] = pd.array(
            range(1, len(table) + 1) if value.ndim == 1 else [None] * len(table),
            "Int64",
        )
        table["time_s"] = value[:, 0] if value.ndim == 2 else np.nan
        tables.append(
            table.assign(model=model, quantity=quantity, unit=UNITS[quantity])
        )
    return pd.concat(tables)[["model", "quantity", "block", "time_s", "value", "unit"]]
