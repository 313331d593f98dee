"""Each number is tabulated for every N."""

from functools import cache

import pandas as pd
from golden.kept import SMALL
from studies.made import chunks_of, noise_made

from maegawa2010.studies.resolution import figure
from maegawa2010.studies.resolution import tables as resolution


@cache
def small() -> dict[str, pd.DataFrame]:
    """The tables of few runs of few blocks."""
    few = chunks_of("resolution_members", seed=1, n_blocks=[2, 4], runs=[6, 6])
    noise = noise_made()["noise_members"]
    return resolution.resolution_tables(few, noise)


def numbers_by_n():
    table = pd.read_csv(SMALL / "resolution.csv")
    return figure.draw(table, papers_n=12, mu_k=0.45)


TABLES = {"resolution": lambda: small()["resolution"]}
PICTURES = {"resolution": numbers_by_n}


def test_differences_of_a_finer_study_take_the_place_of_those_with_the_same_n():
    own = pd.DataFrame({"n_blocks": [10, 20, 20], "low": 1.0})
    finer = pd.DataFrame({"n_blocks": [20, 40], "low": 2.0})
    found = resolution.with_finer(own, [finer])
    assert found["n_blocks"].tolist() == [10, 20, 40]
    assert found["low"].tolist() == [1.0, 2.0, 2.0]
