"""Numbers of the scenes: those that the paper prints, and those that no other table
has."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import asdict

import pandas as pd

from precursors.analysis.slip_rows import first_global
from precursors.analysis.slips import DEFINITIONS, find_slips, first_global_slip
from precursors.model.statics import maximal_compressions
from precursors.solver.run import Run

MU_SAPP_COLUMNS = [
    "scene",
    "global_slip",
    "largest",
    "mu_sapp",
    "load_N",
    "time_s",
    "event",
    "events_counted",
    "is_papers",
]
# Quantities of the table of the paper's numbers: the events counted in Fig. 13 and
# mu_sapp; of the first global slip time, load and number among all events; and the
# events that are longer than all before, without those as long.
UNITS = {
    "events_counted": "1",
    "mu_sapp": "1",
    "time_s": "s",
    "load_N": "N",
    "events": "1",
    "records": "1",
}


def measures_table(runs: Mapping[str, Run]) -> pd.DataFrame:
    """One row per scene: parameters of its chain (Eqs. 2-10) and its residual strain,
    units in the names."""
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
    """Compression of the slider when its first global slip begins, over the largest at
    rest (Eqs. 11, 12).

    NaN without a global slip, and for one block.
    """
    slips = find_slips(run)
    first = first_global(slips)
    if first is None or run.chain.n_blocks == 1:
        return math.nan
    compressions = (
        run.spring_forces(slips["onset"].iloc[[first]])[0] / run.chain.springs
    )
    return float(compressions[1:].sum() / maximal_compressions(run.chain)[1:].sum())


def reproduction_tables(
    slips: Mapping[str, pd.DataFrame], paper: Mapping[str, Mapping[str, float]]
) -> dict[str, pd.DataFrame]:
    """Both tables of the paper's numbers, by file name."""
    mu_sapp = mu_sapp_table(slips)
    return {
        "mu_sapp": mu_sapp,
        "reproduction": reproduction_table(slips, mu_sapp, paper),
    }


def mu_sapp_table(slips: Mapping[str, pd.DataFrame]) -> pd.DataFrame:
    """mu_sapp (Eq. 1) of each scene under each definition, none where it has no global
    slip in that sense.

    `global_slip` and `largest` are those of the `Definition`.
    """
    rows = [
        {
            "scene": scene,
            "global_slip": definition.global_slip,
            "largest": definition.largest,
            "is_papers": definition is DEFINITIONS[0],
        }
        | asdict(friction)
        for scene, table in slips.items()
        for definition in DEFINITIONS
        if (friction := first_global_slip(table, definition))
    ]
    named = pd.DataFrame(rows).rename(columns={"load": "load_N", "time": "time_s"})
    return named.reindex(columns=MU_SAPP_COLUMNS)


def reproduction_table(
    slips: Mapping[str, pd.DataFrame],
    mu_sapp: pd.DataFrame,
    paper: Mapping[str, Mapping[str, float]],
) -> pd.DataFrame:
    """One row per scene and quantity, from the slip table of each scene and
    tables/mu_sapp.csv.

    `paper` has what the paper prints of each scene: events_counted and mu_sapp, or
    nothing.
    """
    papers = mu_sapp[mu_sapp["is_papers"].astype(bool)].set_index("scene")["mu_sapp"]
    rows = []
    for scene, table in slips.items():
        found = quantities(table) | {"mu_sapp": papers.get(scene)}
        theta = next(iter(table["theta"]), None)
        for quantity, unit in UNITS.items():
            row = {"scene": scene, "theta": theta, "quantity": quantity, "unit": unit}
            numbers = {
                "paper": paper[scene].get(quantity),
                "reproduced": found.get(quantity),
            }
            rows.append(row | numbers)
    return pd.DataFrame(rows)


def quantities(slips: pd.DataFrame) -> dict[str, float | None]:
    """Numbers of a scene by quantity, without mu_sapp; only the counts without a global
    slip."""
    counted = slips.loc[slips["counted"].astype(bool), "front"]
    found: dict[str, float | None] = {
        "events_counted": len(counted),
        "records": counted.nunique(),
    }
    first = first_global(slips)
    if first is not None:
        found["time_s"] = slips["onset_s"].iloc[first]
        found["load_N"] = slips["load_before_N"].iloc[first]
        found["events"] = first + 1
    return found
