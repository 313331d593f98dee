"""The table of definitions tells which readings give the paper's numbers, and its figure shows them."""

import pytest
from matplotlib.figure import Figure

from precursors.figures.definitions import draw
from precursors.methods.columns import SWITCHING_RULES
from precursors.model.switching import COULOMB, KINETIC
from precursors.reproduction.definitions import definitions_table
from precursors.support.files import read_table, write_table

SLIDER = {
    "n_blocks": 10,
    "mu_s": 0.70,
    "mu_k": 0.45,
    "normal_load": 400.0,
    "drive_stiffness": 0.8e6,
    "drive_velocity": 1e-4,
    "slider_mass": 0.012,
    "youngs_modulus": 2.5e9,
    "cross_section": 1e-4,
    "length": 0.1,
}
PAPER = [{"events_counted": counted, "mu_sapp": 0.49} for counted in (6, 9, 14)]
READING = ["degree", "switching", "global_slip", "short", "front"]
AT_ONCE = "in which all blocks slide at the same instant"


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    path = tmp_path_factory.mktemp("definitions") / "definitions.csv"
    write_table(definitions_table(SLIDER, 4.0, ["5/6", 0.833], [5.0, 10.0], PAPER), path)
    return path


@pytest.fixture(scope="module")
def table(path):
    return read_table(path)


def test_each_reading_has_a_row_for_each_sign_of_each_size_of_theta(table):
    assert len(table) == 2 * 3 * len(SWITCHING_RULES) * (4 * 3 * 3)
    assert not table.duplicated([*READING, "theta"]).any()
    assert sorted(table["theta"].unique()) == pytest.approx([-5 / 6, -0.833, 0, 0.833, 5 / 6], rel=1e-15)


def test_the_papers_numbers_come_of_few_readings_and_only_with_five_sixths(table):
    best = table[table["numbers_within_a_digit"] == 6][READING].drop_duplicates()
    assert set(best["degree"]) == {"5/6"}
    assert set(best["switching"]) == {COULOMB, KINETIC}
    assert set(best["short"]) == {"shorter than one before it"}
    assert set(best["global_slip"]) == {AT_ONCE, "in which F_X drops by more than 10 N"}
    assert set(best["front"]) == {"farthest block that slid", "number of blocks that slid"}


def test_no_reading_gives_six_numbers_as_printed_because_0_4845_rounds_to_0_48(table):
    assert table["numbers_as_printed"].max() == 5
    papers = table[
        (table["switching"] == COULOMB)
        & (table["global_slip"] == AT_ONCE)
        & (table["numbers_as_printed"] == 5)
    ]
    wrong = papers[~papers["mu_sapp_is_papers_as_printed"]]
    assert wrong["mu_sapp"].round(4).unique().tolist() == [0.4845]


def test_numbers_of_a_reading_are_counted_over_its_three_loadings(table):
    agree = table["events_counted_is_papers"].astype(int) + table["mu_sapp_is_papers_within_a_digit"]
    counted = agree.groupby([table[key].astype(str) for key in READING]).sum()
    given = table.groupby([table[key].astype(str) for key in READING])["numbers_within_a_digit"]
    assert (given.nunique() == 1).all()
    assert (given.first() == counted).all()


def test_a_reading_without_a_global_slip_has_empty_numbers(tmp_path):
    write_table(definitions_table(SLIDER, 0.4, ["5/6"], [], [{}, {}, {}]), tmp_path / "few.csv")
    few = read_table(tmp_path / "few.csv")
    assert few["mu_sapp"].isna().all()
    assert not few["numbers_within_a_digit"].any()
    assert isinstance(draw(few), Figure)


def test_the_figure_has_a_cell_for_each_reading_and_theta(table):
    left, right = draw(table).axes[:2]
    cells = [
        text.get_text() for text in left.texts if "\n" in text.get_text() and text.get_text()[0].isdigit()
    ]
    n_readings = 4 * 3 * 2  # the farthest block and the number that slid give the same, and share a row
    assert len(cells) == n_readings * 5
    assert cells[:5] == ["6\n0.484", "6\n0.484", "9\n0.486", "15\n0.546", "14\n0.488"]
    assert [text.get_text() for text in right.texts[:2]] == ["4", "6"]
