"""The dynamic chains as rungs of the ladder: the exact solver, up to the first global slip.

The paper's chain, and the three additions to it: internal viscosity, interface springs, a head with mass.
"""

from __future__ import annotations

from functools import partial
from typing import NamedTuple

import numpy as np
import pandas as pd

from precursors.analysis.slips import apparent_friction, find_slips
from precursors.hierarchy.quantities import Model, events_kept, first_load, front_loads, slip_duration
from precursors.model.chain import Chain, FloatArray, require_plain
from precursors.model.scene_models import (
    ADDED,
    EVENTS_KEPT,
    FIRST_LOAD,
    FRONT_LOADS,
    MU_SAPP,
    PAPERS_MODEL,
    SLIP_DURATION,
    WAVEFORM,
)
from precursors.solver.run import Run
from precursors.solver.simulate import simulate

# In units of the time in which the drive reaches mu_s F_Z against all springs in a row.
LIMIT = 10.0


class Motion(NamedTuple):
    """A run to the end of the first global slip, and its slip events."""

    run: Run
    slips: pd.DataFrame


def to_global_slip(chain: Chain) -> Motion:
    """Simulate a chain to the end of its first global slip, or to `LIMIT`."""
    yielding = 1.0 / chain.drive_stiffness + (chain.n_blocks - 1) / chain.stiffness
    limit = LIMIT * chain.mu_s * chain.normal_load * yielding / chain.drive_velocity
    run = simulate(chain, limit, until="global slip")
    return Motion(run, find_slips(run))


def _mu_sapp(motion: Motion) -> float:
    friction = apparent_friction(motion.run, motion.slips)
    return np.nan if friction is None else friction.mu_sapp


def _waveform(motion: Motion) -> FloatArray:
    """Time [s] and load [N] at the start and at every transition, shape (n_transitions + 1, 2)."""
    transitions = motion.run.transitions
    return np.column_stack(
        [np.append(0.0, transitions["time"]), np.append(0.0, transitions["tangential_load"])]
    )


_ANSWERS = {
    FIRST_LOAD: lambda motion: first_load(motion.slips),
    EVENTS_KEPT: lambda motion: events_kept(motion.slips),
    MU_SAPP: _mu_sapp,
    FRONT_LOADS: lambda motion: front_loads(motion.slips, motion.run.chain.n_blocks),
    SLIP_DURATION: lambda motion: slip_duration(motion.slips),
    WAVEFORM: _waveform,
}


def _plain(chain: Chain) -> Motion:
    require_plain(chain)
    return to_global_slip(chain)


def _extended(chain: Chain, addition: str) -> Motion:
    if not getattr(chain, addition):
        raise ValueError(f"{addition} = 0: allowed is {addition} > 0 where the model is named after it")
    return to_global_slip(chain)


def _model(name: str, label: str) -> Model:
    return Model(name, label, _ANSWERS, partial(_extended, addition=ADDED[name]))


CHAIN = Model(PAPERS_MODEL, "paper's chain", _ANSWERS, _plain)
VISCOUS = _model("viscous", "with viscosity")
INTERFACE = _model("interface", "with interface springs")
HEAD = _model("head", "with head mass")
