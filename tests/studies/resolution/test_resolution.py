"""Each number is tabulated for every N."""

import pandas as pd
from places import committed, made

from maegawa2010.studies.resolution import figure
from maegawa2010.studies.resolution import tables as resolution


def numbers_by_n():
    finer = committed("resolution_full")
    return figure.draw(made("resolution"), papers_n=10, mu_k=0.45, finer=finer)


PICTURES = {"resolution": numbers_by_n}


def test_a_finer_study_is_drawn_to_its_end_and_the_title_says_where_it_ends():
    counts, frictions = numbers_by_n().axes
    for axes in (counts, frictions):
        assert max(line.get_xdata()[-1] for line in axes.lines[:9]) == 320
    assert counts.get_title() == "More blocks, more events"
    assert frictions.get_title() == r"With many blocks, every median is near $\mu_k$"


def test_differences_of_a_finer_study_take_the_place_of_those_with_the_same_n():
    own = pd.DataFrame({"n_blocks": [10, 20, 20], "low": 1.0})
    finer = pd.DataFrame({"n_blocks": [20, 40], "low": 2.0})
    found = resolution.with_finer(own, [finer])
    assert found["n_blocks"].tolist() == [10, 20, 40]
    assert found["low"].tolist() == [1.0, 2.0, 2.0]
