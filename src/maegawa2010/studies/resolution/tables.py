"""Convergence with N: which numbers of the paper depend on how finely the slider is cut
into blocks."""

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import pandas as pd

from maegawa2010.studies.members import (
    Study,
    differences_table,
    draws,
    gather,
    noise_table,
    stack,
)


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
        "resolution": noise_table(members),
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
