"""Each number is tabulated for every N."""

from functools import cache

import pandas as pd
from golden.kept import SMALL
from settings import CONFIG
from studies.made import chunks_of, noise_made

from maegawa2010.studies.resolution import figure
from maegawa2010.studies.resolution import tables as resolution


@cache
def small() -> dict[str, pd.DataFrame]:
    """The tables of few runs of few blocks."""
    few = chunks_of("resolution_members", seed=1, n_blocks=[2, 4], runs=[6, 6])
    noise = noise_made()["noise_members"]
    return resolution.resolution_tables(few, noise, "fig10")


def numbers_by_n():
    foreseen = {
        "scene": "fig10",
        "n_blocks": [2, 4],
        "horizon_s": 2.5,
        "predictable": [True, False],
    }
    table = pd.read_csv(SMALL / "resolution.csv")
    return figure.draw(table, pd.DataFrame(foreseen), papers_n=12, mu_k=0.45)


TABLES = {
    name: lambda name=name: small()[name] for name in ("resolution", "counts_by_n")
}
PICTURES = {"resolution": numbers_by_n}


def test_differences_of_a_finer_study_take_the_place_of_those_with_the_same_n():
    own = pd.DataFrame({"n_blocks": [10, 20, 20], "low": 1.0})
    finer = pd.DataFrame({"n_blocks": [20, 40], "low": 2.0})
    found = resolution.with_finer(own, [finer])
    assert found["n_blocks"].tolist() == [10, 20, 40]
    assert found["low"].tolist() == [1.0, 2.0, 2.0]


def test_equal_counts_differ_by_chance_only():
    """Also with SciPy 1.18, whose test has no answer without variance."""
    members = pd.DataFrame({"scene": ["even", "tilted"] * 3, "n_blocks": 2, "draw": 1})
    members = members.assign(
        theta=0.0, reached=True, **dict.fromkeys(resolution.COUNTS, 3)
    )
    counts = resolution.counts_table(members, "even")
    assert (counts.filter(like="_p") == 1).all(axis=None)


def test_the_papers_run_is_predictable_and_thirty_blocks_with_a_heavy_trailing_edge_are_not():
    """At N = 30 and theta = 5/6 the horizon of the run is shorter than its first global
    slip."""
    slider = {"s": {**CONFIG["chain"], "theta": 5 / 6}}
    table = resolution.predictability_table(slider, [10, 30], 10.0, 1e-9)
    assert table["predictable"].tolist() == [True, False]
