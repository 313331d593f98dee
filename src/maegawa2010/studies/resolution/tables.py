"""Convergence with N: which numbers of the paper depend on how finely the slider is cut
into blocks."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import pandas as pd
from scipy.stats import mannwhitneyu

from maegawa2010.studies.members import (
    Study,
    differences_table,
    draws,
    gather,
    noise_table,
    stack,
    with_noise,
)
from precursors.analysis.horizon import horizon
from precursors.model.chain import Chain
from precursors.solver.simulate import simulate

# All slip events up to the first global slip, and those of Fig. 13, which are never
# shorter than one before.
COUNTS = ("events_to_global_slip", "events_counted")
QUANTITIES = (*COUNTS, "mu_sapp", "global_slip_s")
POINT = ["scene", "theta", "n_blocks"]


def resolution_study(
    sliders: Mapping[str, Mapping[str, Any]],
    duration: float,
    settings: Mapping[str, Any],
) -> Study:
    """Chains of more and more blocks with the loading of some scenes.

    Draw 0 of each chain has the normal loads of Eq. 7, the others have them with noise.
    Chains with as many blocks as the scene are those of `noise_study`.
    """
    blocks: list[dict[str, Any]] = []
    sizes = list(zip(settings["n_blocks"], settings["runs"], strict=True))
    for scene, slider in sliders.items():
        for n_blocks, runs in sizes:
            if n_blocks != slider["n_blocks"]:
                block = {**slider, "n_blocks": n_blocks, "duration": duration}
                block |= {"scene": scene, **draws(runs), "group": len(blocks)}
                blocks.append(block)
    return Study(stack(blocks), seed=settings["seed"])


def resolution_tables(
    chunks: Iterable[pd.DataFrame],
    noise: pd.DataFrame,
    uniform: str,
    finer: Sequence[pd.DataFrame] = (),
) -> dict[str, pd.DataFrame]:
    """The tables of the study, by file name; `noise` has the members with the scenes'
    own N.

    `finer` has differences from a larger study, which take the place of those with the
    same N.
    """
    gathered = gather(chunks)
    members = pd.concat([noise, gathered]).sort_values("n_blocks", kind="stable")
    return {
        "resolution_members": gathered,
        "resolution": noise_table(members, POINT, QUANTITIES),
        "counts_by_n": counts_table(members, uniform),
        "resolution_differences": with_finer(differences_by_n(members), finer),
    }


def differences_by_n(members: pd.DataFrame) -> pd.DataFrame:
    """Differences of mu_sapp between loadings, as in `differences_table`, for each N."""
    tables = {
        n: differences_table(runs).query("quantity == 'mu_sapp'")
        for n, runs in members.groupby("n_blocks")
    }
    return pd.concat(tables, names=["n_blocks"]).reset_index("n_blocks")


def with_finer(table: pd.DataFrame, finer: Iterable[pd.DataFrame]) -> pd.DataFrame:
    """The table with rows of others, instead of its own with the same N."""
    for other in finer:
        own = table[~table["n_blocks"].isin(other["n_blocks"])]
        table = pd.concat([own, other]).sort_values("n_blocks", kind="stable")
    return table


def counts_table(members: pd.DataFrame, uniform: str) -> pd.DataFrame:
    """Counts of events against N, one row per n_blocks and scene.

    Each row has the median of each count, also over that of the scene `uniform`, with
    the probability by chance of such a difference from this scene (two-sided test of
    Mann and Whitney).
    """
    runs = with_noise(members)
    rows = []
    for (n_blocks, scene, theta), own in runs.groupby(
        ["n_blocks", "scene", "theta"], sort=False
    ):
        even = runs[(runs["n_blocks"] == n_blocks) & (runs["scene"] == uniform)]
        row = {"n_blocks": n_blocks, "scene": scene, "theta": theta, "runs": len(own)}
        for count in COUNTS:
            row[count] = own[count].median()
            row[f"{count}_over_uniform"] = own[count].median() / even[count].median()
            # Equal counts have no variance: newer SciPy gives nan for them.
            is_equal = len({*own[count], *even[count]}) == 1
            p = 1.0 if is_equal else mannwhitneyu(own[count], even[count]).pvalue
            row[f"{count}_p"] = p
        rows.append(row)
    return pd.DataFrame(rows).sort_values(["n_blocks", "theta"], ignore_index=True)


def predictability_table(
    sliders: Mapping[str, Mapping[str, Any]],
    n_blocks: Iterable[int],
    duration: float,
    tolerance: float,
) -> pd.DataFrame:
    """Predictability time (horizon_s) and end of the first global slip, without noise:
    a row per scene and N.

    Where the horizon is not before the end, the run is `predictable`: its numbers do
    not depend on rounding.
    """
    rows = []
    for scene, slider in sliders.items():
        for n in n_blocks:
            run = simulate(
                Chain.from_slider(**{**slider, "n_blocks": n}),
                duration,
                until="global slip",
            )
            found = {
                "horizon_s": horizon(run, tolerance),
                "global_slip_end_s": run.duration,
            }
            predictable = found["horizon_s"] >= run.duration
            rows.append(
                {"scene": scene, "n_blocks": n, **found, "predictable": predictable}
            )
    return pd.DataFrame(rows)
