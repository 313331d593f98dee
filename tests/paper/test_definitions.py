"""Numbers of a slip table under readings of the paper's words, and the readings that give
the paper's numbers."""

import pandas as pd
import pytest

from maegawa2010.paper.definitions import OF_SCENES, Reading, definitions_table
from precursors import Chain, simulate
from precursors.analysis.summary import summary_of

# One quotient of doubles.
ROUNDING = 1e-15
# Front, blocks that slid, most at the same time, and load before and after, for five
# events of a chain of three blocks.
EVENTS = pd.DataFrame(
    [
        (2, 2, 1, 9.0, 8.0),
        (1, 1, 1, 10.0, 9.5),
        (2, 2, 2, 11.0, 8.0),
        (3, 3, 2, 12.0, 10.0),
        (3, 3, 3, 11.0, 5.0),
    ],
    columns=["front", "n_slid", "n_simultaneous", "load_before_N", "load_after_N"],
)
EVENTS = EVENTS.assign(
    onset_s=EVENTS.index,
    end_s=EVENTS.index,
    largest_load_N=EVENTS["load_before_N"].cummax(),
    is_global=EVENTS["n_simultaneous"] == 3,
    n_blocks=3,
    normal_load_N=20.0,
)
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


def test_each_reading_differs_from_ours_in_one_respect(table):
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


def test_four_readings_have_all_six_numbers_of_the_paper(table):
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


@pytest.mark.parametrize(
    ("reading", "events", "counted", "mu_sapp"),
    [
        (Reading(), 5, 4, 0.6),
        (Reading(global_slip="each"), 4, 3, 0.6),
        (Reading(global_slip=2.5), 3, 2, 0.55),
        (Reading(short="not longer"), 5, 2, 0.6),
        (Reading(short="shorter than the last"), 5, 4, 0.6),
        (
            Reading(global_slip="each", front="n_simultaneous", short="not longer"),
            4,
            2,
            0.6,
        ),
    ],
)
def test_a_reading_selects_global_and_short_events(reading, events, counted, mu_sapp):
    summary = summary_of(reading.read(EVENTS))
    assert (summary.events_to_global_slip, summary.events_counted) == (events, counted)
    assert summary.mu_sapp == pytest.approx(mu_sapp, rel=ROUNDING)
