"""What a scene is and how its first global slip comes: numbers of the run that no other table has."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np
import pandas as pd

from precursors.analysis.slip_rows import first_global
from precursors.analysis.slips import find_slips
from precursors.model.chain import Chain
from precursors.model.statics import maximal_compressions
from precursors.solver.run import Run


def measures_table(runs: Mapping[str, Run]) -> pd.DataFrame:
    """One row per scene: parameters of its chain (Eqs. 2-10), and how its first global slip comes."""
    return pd.DataFrame(
        {"scene": scene, **parameters(run.chain), **up_to_global_slip(run)} for scene, run in runs.items()
    )


def parameters(chain: Chain) -> dict[str, float]:
    """The chain's parameters, units in the names; of the normal loads the first, the last and the sum."""
    return {
        "n_blocks": chain.n_blocks,
        "mu_s": chain.mu_s,
        "mu_k": chain.mu_k,
        "normal_load_N": float(chain.weights.sum()),
        "first_normal_load_N": float(chain.weights[0]),
        "last_normal_load_N": float(chain.weights[-1]),
        "block_mass_kg": chain.mass,
        "stiffness_N_per_m": chain.stiffness,
        "drive_stiffness_N_per_m": chain.drive_stiffness,
        "drive_velocity_m_per_s": chain.drive_velocity,
    }


def up_to_global_slip(run: Run) -> dict[str, float]:
    """Where events begin, releases backward, residual strain (NaN without a global slip), transitions."""
    slips, transitions = find_slips(run), run.transitions
    begins_at = transitions["block"][np.searchsorted(transitions["time"], slips["onset"])]
    first = first_global(slips)
    backward = strain = math.nan
    if first is not None:
        onset = float(slips["onset"].iloc[first])
        earlier = transitions[transitions["time"] < onset]
        backward = float(np.count_nonzero(earlier["mode"] == -1))
        strain = residual_strain(run, onset)
    return {
        "share_of_events_from_block_1": float(np.mean(begins_at == 1)) if len(slips) else math.nan,
        "backward_releases": backward,
        "residual_strain": strain,
        "transitions": float(len(transitions)),
    }


def residual_strain(run: Run, time: float) -> float:
    """Compression of the slider at a time [s] over the largest at rest (Eqs. 11, 12); NaN for one block."""
    if run.chain.n_blocks == 1:
        return math.nan
    compressions = run.spring_forces([time])[0] / run.chain.springs
    return float(compressions[1:].sum() / maximal_compressions(run.chain)[1:].sum())
