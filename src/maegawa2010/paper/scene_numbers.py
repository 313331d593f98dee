"""Numbers of the scenes: those printed in the paper, and the parameters of their chains."""

import math
from collections.abc import Mapping

import pandas as pd

from precursors.analysis.summary import summarise, summary_of
from precursors.model.statics import maximal_compressions
from precursors.solver.run import Run

# Attributes of `Summary` that are compared with the paper, and their units.
UNITS = {
    "events_counted": "1",
    "mu_sapp": "1",
    "global_slip_s": "s",
    "global_slip_load_N": "N",
    "events_to_global_slip": "1",
}


def measures_table(runs: Mapping[str, Run]) -> pd.DataFrame:
    """One row per scene: parameters of its chain (Eqs. 2-10) and its residual strain;
    column names end with units."""
    return pd.DataFrame(
        {
            "scene": scene,
            "n_blocks": run.chain.n_blocks,
            "mu_s": run.chain.mu_s,
            "mu_k": run.chain.mu_k,
            "normal_load_N": run.chain.normal_load,
            "block_mass_kg": run.chain.mass,
            "stiffness_N_per_m": run.chain.stiffness,
            "drive_stiffness_N_per_m": run.chain.drive_stiffness,
            "drive_velocity_m_per_s": run.chain.drive_velocity,
            "residual_strain": residual_strain(run),
        }
        for scene, run in runs.items()
    )


def residual_strain(run: Run) -> float:
    """Compression of the slider at the onset of its first global slip, over the largest
    compression at rest (Eqs. 11, 12).

    NaN without a global slip, and for one block.
    """
    summary = summarise([run])
    if not summary["reached"].item() or run.chain.n_blocks == 1:
        return math.nan
    compressions = run.spring_forces(summary["global_slip_s"])[0] / run.chain.springs
    return float(compressions[1:].sum() / maximal_compressions(run.chain)[1:].sum())


def reproduction_table(
    slips: Mapping[str, pd.DataFrame], paper: Mapping[str, Mapping[str, float]]
) -> pd.DataFrame:
    """One row per scene and quantity, from the slip table of each scene.

    `paper` has the numbers printed for each scene: events_counted and mu_sapp, or none.
    """
    rows = []
    for scene, table in slips.items():
        summary = summary_of(table)
        theta = next(iter(table["theta"]), None)
        for quantity, unit in UNITS.items():
            row = {"scene": scene, "theta": theta, "quantity": quantity, "unit": unit}
            row["paper"] = paper[scene].get(quantity)
            row["reproduced"] = getattr(summary, quantity)
            rows.append(row)
    return pd.DataFrame(rows)
