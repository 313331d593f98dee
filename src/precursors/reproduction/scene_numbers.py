"""Numbers of the scenes: those that the paper prints, and those that no other table
has."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import asdict

import pandas as pd

from precursors.analysis.slip_rows import first_global
from precursors.analysis.slips import DEFINITIONS, apparent_friction, find_slips
from precursors.model.statics import maximal_compressions
from precursors.solver.run import Run

MU_SAPP_COLUMNS = [
    *(
        "scene",
        "definition",
        "mu_sapp",
        "load_N",
        "time_s",
        "event",
        "events_counted",
        "is_papers",
    )
]
COLUMNS = ["scene", "theta", "quantity", "unit", "paper", "reproduced"]
COUNTED = "events counted in Fig. 13, the first global slip included"
FRICTION = "apparent static friction coefficient mu_sapp"


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
    slip in that sense."""
    rows = [
        {
            "scene": scene,
            "definition": definition.text,
            "is_papers": definition is DEFINITIONS[0],
        }
        | asdict(friction)
        for scene, table in slips.items()
        for definition in DEFINITIONS
        if (friction := apparent_friction(table, definition))
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
    rows = [
        (
            scene,
            next(iter(table["theta"]), None),
            quantity,
            unit,
            paper[scene].get(key),
            value,
        )
        for scene, table in slips.items()
        for quantity, unit, key, value in quantities(table, papers.get(scene))
    ]
    return pd.DataFrame(rows, columns=COLUMNS)


def quantities(
    slips: pd.DataFrame, mu_sapp: float | None
) -> Iterator[tuple[str, str, str, float | None]]:
    """Quantity, unit, key in `paper` (empty: none), and value (None without a global
    slip)."""
    yield COUNTED, "1", "events_counted", float(slips["counted"].sum())
    yield FRICTION, "1", "mu_sapp", mu_sapp
    number = first_global(slips)
    time, load = (
        (None, None)
        if number is None
        else slips[["onset_s", "load_before_N"]].iloc[number]
    )
    yield "time of the first global slip", "s", "", time
    yield "load at the first global slip", "N", "", load
    yield (
        "all events up to the first global slip",
        "1",
        "",
        None if number is None else number + 1,
    )
