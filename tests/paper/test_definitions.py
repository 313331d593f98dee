"""The table of definitions tells which readings give the paper's numbers."""

import pandas as pd
import pytest

from maegawa2010.paper.definitions import OF_SCENES, definitions_table
from precursors import Chain, simulate

SLIDER = {"n_blocks": 10, "mu_s": 0.70, "mu_k": 0.45, "normal_load": 400.0}
PAPER = [{"events_counted": counted, "mu_sapp": 0.49} for counted in (6, 9, 14)]


def tabulate(duration, load_drops, paper=PAPER) -> pd.DataFrame:
    runs = [
        simulate(Chain.from_slider(theta=theta), duration)
        for theta in (-5 / 6, 0.0, 5 / 6)
    ]
    return definitions_table(runs, SLIDER, duration, [0.833], load_drops, paper)


@pytest.fixture(scope="module")
def table() -> pd.DataFrame:
    return tabulate(3.0, [5.0, 10.0])


def test_each_reading_differs_from_ours_in_the_one_thing_that_is_changed(table):
    columns = ["degree", "switching", "global_slip", "short", "front"]
    changed = {
        "global_slip": 3,
        "short": 2,
        "front": 2,
        "degree": 1,
        "switching": 2,
    }
    readings = table.iloc[::3]
    assert readings["changed"].value_counts().to_dict() == {"nothing": 1, **changed}
    differ = readings[columns] != readings[columns].iloc[0]
    for name, reading in zip(readings["changed"], differ.to_numpy(), strict=True):
        assert differ.columns[reading].tolist() == [name] * (name != "nothing")
    assert table[table["degree"] == OF_SCENES]["theta"].unique() == pytest.approx(
        [-5 / 6, 0, 5 / 6]
    )


def test_the_readings_that_give_six_numbers_are_ours_and_three_others(table):
    six = table[table["numbers_within_a_digit"] == 6].iloc[::3]
    assert six[
        ["changed", "global_slip", "front", "switching"]
    ].to_numpy().tolist() == [
        ["nothing", "at once", "front", "static"],
        ["global_slip", 10.0, "front", "static"],
        ["front", "at once", "n_slid", "static"],
        ["switching", "at once", "front", "kinetic"],
    ]
    assert six["reading"].tolist() == [
        "our reading",
        "global slip: in which F_X drops by more than 10 N",
        "length: number of blocks that slid",
        "switching: sticks if |F| <= mu_k w",
    ]
    assert table["mu_sapp"][:3].round(4).tolist() == [0.4845, 0.4858, 0.4883]


def test_a_reading_without_a_global_slip_has_empty_numbers():
    few = tabulate(0.4, [], [{}, {}, {}])
    assert few["mu_sapp"].isna().all()
    assert not few["numbers_within_a_digit"].any()
