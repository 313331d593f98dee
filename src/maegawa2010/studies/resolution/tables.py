"""Convergence with N: which numbers of the paper depend on how finely the slider is cut
into blocks."""

from collections.abc import Iterable, Mapping
from typing import Any

import pandas as pd

from maegawa2010.paper.committed import compared
from maegawa2010.studies.members import (
    Study,
    chain_of,
    differences_table,
    draws,
    gather,
    noise_table,
    stack,
)
from maegawa2010.studies.runs import known_until, so_far, up_to_global_slip
from maegawa2010.support.run_statistics import QUANTILES
from precursors.solver.simulate import simulate

CHAIN_OF_ROW = ["scene", "n_blocks"]
ROW = [*CHAIN_OF_ROW, "quantity"]  # columns that name a row of resolution.csv
# Of the first run made again, as far as it is predictable (`UNPREDICTED_S`): counts are
# the same, times to twice the error, loads to five times what the drive adds in it.
OF_FIRST = {
    "events_to_global_slip": 0.0,
    "events_counted": 0.0,
    "mu_sapp": 1e-6,
    "global_slip_s": 2e-6,
}
ROUNDING = 1e-12  # of medians, and what follows from them
WHOLE = 1e-6  # of a study that is predictable to its end, made again whole


def resolution_study(
    sliders: Mapping[str, Mapping[str, Any]],
    duration: float,
    settings: Mapping[str, Any],
) -> Study:
    """Chains of more and more blocks with the loading of some scenes.

    All have noise in the normal loads of Eq. 7. Those with as many blocks as the scene
    are in `noise_study`.
    """
    blocks: list[dict[str, Any]] = []
    sizes = list(zip(settings["n_blocks"], settings["runs"], strict=True))
    for scene, slider in sliders.items():
        for n_blocks, runs in sizes:
            if n_blocks != slider["n_blocks"]:
                block = {**slider, "n_blocks": n_blocks, "duration": duration}
                block |= {"scene": scene, **draws(runs), "group": len(blocks)}
                blocks.append(block)
    members = stack(blocks).query("draw > 0").reset_index(drop=True)
    return Study(members, seed=settings["seed"])


def resolution_tables(
    chunks: Iterable[pd.DataFrame], noise: pd.DataFrame
) -> dict[str, pd.DataFrame]:
    """The tables of the study, by file name; `noise` has the members with the scenes'
    own N."""
    members = pd.concat([noise, gather(chunks)]).sort_values("n_blocks", kind="stable")
    return {
        "resolution": noise_table(members),
        "resolution_differences": differences_by_n(members),
    }


def with_first(table: pd.DataFrame, study: Study) -> pd.DataFrame:
    """resolution.csv with what the first run with noise of each chain gives until it can
    no longer be made again: known_s, and `first`, the number of `so_far`."""
    return table.merge(first_runs(study), how="left", on=ROW)


def first_runs(study: Study, known_s: pd.Series | None = None) -> pd.DataFrame:
    """A row for each number of the first run with noise of each chain; known_s is given
    by scene and n_blocks, or comparisons."""
    rows = []
    for member in study.members.query("draw == 1").to_dict("records"):
        chain, key = chain_of(member, study.seed), (member["scene"], member["n_blocks"])
        if known_s is None:
            (run,) = up_to_global_slip([chain], member["duration"])
            known = known_until(run)
        else:
            known = float(known_s[key])
        numbers = so_far(simulate(chain, known, "global slip"))
        labels = dict(zip(CHAIN_OF_ROW, key, strict=True)) | {"known_s": known}
        rows += [labels | {"quantity": name, "first": x} for name, x in numbers.items()]
    return pd.DataFrame(rows)


def check(
    tables: Mapping[str, pd.DataFrame], study: Study, noise: Mapping[str, pd.DataFrame]
) -> pd.DataFrame:
    """Compare the committed tables, by name, with the first run of each chain made
    again, and the differences with the medians; `noise` has the tables of the study of
    noise of this build, which are those of the scenes' own N."""
    medians, differences = tables["resolution"], tables["resolution_differences"]
    known_s = medians.dropna(subset="first").groupby(CHAIN_OF_ROW)["known_s"].first()
    again = first_runs(study, known_s)
    tolerances = {"first": again["quantity"].map(OF_FIRST)}
    comparisons = [compared("resolution", medians, again, ROW, tolerances)]
    q50 = medians.set_index(ROW)["q50"].rename("difference")
    pair = [*ROW, "other"]
    pairs = differences[pair]
    others = pairs.drop(columns="scene").rename(columns={"other": "scene"})
    of_pairs = [q50.loc[pd.MultiIndex.from_frame(of[ROW])] for of in (pairs, others)]
    apart = of_pairs[0].to_numpy() - of_pairs[1].to_numpy()
    by_medians = pairs.assign(difference=apart)
    rounding = {"difference": ROUNDING}
    name = "resolution_differences"
    comparisons.append(compared(name, differences, by_medians, pair, rounding))
    if noise:
        own = noise["noise"]
        quantiles = dict.fromkeys(QUANTILES, WHOLE)
        comparisons.append(compared("resolution", medians, own, ROW, quantiles))
        n_blocks = own["n_blocks"].iloc[0]
        again = noise["noise_differences"].query("quantity == 'mu_sapp'")
        again = again.assign(n_blocks=n_blocks)
        ends = dict.fromkeys(["low", "high"], WHOLE)
        comparisons.append(compared(name, differences, again, pair, ends))
    return pd.concat(comparisons, ignore_index=True)


def differences_by_n(members: pd.DataFrame) -> pd.DataFrame:
    """Differences of mu_sapp between loadings, as in `differences_table`, for each N."""
    tables = {
        n: differences_table(runs).query("quantity == 'mu_sapp'")
        for n, runs in members.groupby("n_blocks")
    }
    return pd.concat(tables, names=["n_blocks"]).reset_index("n_blocks")
