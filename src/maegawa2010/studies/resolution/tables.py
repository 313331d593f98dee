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
# Tolerances of the first run when it is made again, while it is predictable to
# UNPREDICTED_S = 1e-6 s: none for counts, twice this error for times, and for F_X/F_Z five
# times the amount that the drive adds in 1e-6 s.
OF_FIRST = {
    "events_to_global_slip": 0.0,
    "events_counted": 0.0,
    "mu_sapp": 1e-6,
    "global_slip_s": 2e-6,
}
ROUNDING = 1e-12  # tolerance of differences that are computed again from medians
WHOLE = 1e-6  # tolerance of the study of noise, whose runs are predictable to the end


def resolution_study(
    sliders: Mapping[str, Mapping[str, Any]],
    duration: float,
    settings: Mapping[str, Any],
) -> Study:
    """Chains with the loadings of the scenes and other numbers of blocks.

    All have noise in the normal loads of Eq. 7. Chains with the scene's own number of
    blocks are in `noise_study`.
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
    """resolution.csv with the beginning of the first run with noise of each chain.

    The beginning ends at known_s, until when any machine can make it again. `first` has
    its numbers (`so_far`).
    """
    return table.merge(first_runs(study), how="left", on=ROW)


def first_runs(study: Study, known_s: pd.Series | None = None) -> pd.DataFrame:
    """A row for each number of the beginning of each chain's first run with noise.

    The beginning ends at `known_s`, given by scene and n_blocks. Without `known_s` we
    compute its end.
    """
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
    """Compare the committed tables with the first runs made again, with their own medians,
    and with the study of noise.

    `tables` are the committed tables by name. `noise` has the tables of this build's study
    of noise, which has the scenes' own N; it may be empty.
    """
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
