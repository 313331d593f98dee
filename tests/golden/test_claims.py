"""The verdicts on the existing results are the golden ones, and a falsified result changes them."""

from __future__ import annotations

import shutil
from pathlib import Path

import check_claims
import pandas as pd
import pytest
from golden.regenerate import GOLDEN

from precursors.reproduction.claim import HOLDS
from precursors.reproduction.claims import CLAIMS, evaluate
from precursors.reproduction.inputs import CLAIM_TABLES, POINT_TABLES
from precursors.reproduction.open_points import open_points_table
from precursors.reproduction.tables import Tables
from precursors.support.files import read_table

RESULTS = Path(__file__).parents[2] / "results/tables"
# Lyapunov exponents differ from one processor to another: the verdict stays.
VARY = "chaos"
NUMBERS = ["expected", "ours"]


@pytest.fixture
def tables(tmp_path: Path) -> Path:
    """A copy of the tables, to be falsified."""
    for name in CLAIM_TABLES:
        shutil.copy(RESULTS / f"{name}.csv", tmp_path)
    return tmp_path


def falsified(column: pd.Series) -> pd.Series:
    """Other numbers, and flags in another order; texts as they are."""
    if column.dtype == bool:
        return column.sample(frac=1, random_state=1, ignore_index=True)
    numbers = pd.to_numeric(column, errors="coerce")
    # Not the same change in each column, as some claims compare two.
    other = 1 - len(str(column.name)) * numbers
    return other if pd.api.types.is_numeric_dtype(column) else column.where(numbers.isna(), other.astype(str))


def without_exponents(claims: pd.DataFrame) -> pd.DataFrame:
    """Claims as text, but for the Lyapunov exponent."""
    text = claims.astype(str)
    text.loc[text["claim"] == VARY, NUMBERS] = ""
    return text


def written(table: pd.DataFrame, path: Path) -> pd.DataFrame:
    table.to_csv(path, index=False)
    return read_table(path)


def test_claims_and_numbers_are_the_golden_ones(tmp_path):
    found = written(evaluate(Tables(RESULTS)), tmp_path / "claims.csv")
    expected = read_table(GOLDEN / "claims.csv")
    pd.testing.assert_frame_equal(without_exponents(found), without_exponents(expected))


@pytest.mark.parametrize(("name", "make"), [("claims", evaluate), ("open_points", open_points_table)])
def test_the_written_tables_are_what_the_tables_give(name, make, tmp_path):
    found = written(make(Tables(RESULTS)), tmp_path / "found.csv")
    pd.testing.assert_frame_equal(found, read_table(RESULTS / f"{name}.csv"))


def test_the_claims_and_open_points_use_the_tables_that_the_workflow_gives_them_and_no_other():
    for make, names in ((evaluate, CLAIM_TABLES), (open_points_table, POINT_TABLES)):
        tables = Tables(RESULTS)
        make(tables)
        assert set(tables) == set(names)


def test_no_claim_stays_the_same_on_other_numbers():
    true, false = Tables(RESULTS), Tables(RESULTS)
    for name in CLAIM_TABLES:
        false[name] = true[name].apply(falsified)
        for key in {"draw", "scene"} & set(false[name]):
            false[name][key] = true[name][key]
    same = {claim.name for claim in CLAIMS if claim.row(true) == claim.row(false)}
    assert not same


@pytest.mark.parametrize(
    ("table", "column", "rows", "name"),
    [
        ("digits_members", "events_counted", {"scene": "fig10", "draw": 0}, "count-uniform"),
        ("digits_members", "mu_sapp", {"scene": "fig12", "draw": 0}, "friction-leading"),
        ("digits_members", "events_to_global_slip", {"scene": "fig11"}, "short-events"),
        ("digits_members", "mu_sapp", {"scene": "fig11"}, "friction-trailing"),
        ("noise_differences", "verdict", {"quantity": "mu_sapp"}, "friction-independent-of-loading"),
        ("lyapunov", "exponent_per_s", {"scene": "fig10"}, "chaos"),
        ("fig12_trace", "tangential_load_N", {}, "eq15-in-motion"),
    ],
)
def test_one_falsified_column_makes_the_check_fail(tables, capsys, table, column, rows, name):
    path = tables / f"{table}.csv"
    changed = pd.read_csv(path)
    where = pd.Series(True, changed.index)
    for key, value in rows.items():
        where &= changed[key] == value
    if column == "verdict":
        changed.loc[where, column] = "same"
    else:
        factor = -1.0 if table == "lyapunov" else 3.0
        changed[column] = changed[column].astype(float).mask(where, factor * changed[column])
    changed.to_csv(path, index=False)
    with pytest.raises(SystemExit, match=rf"check: {name}: is "):
        check_claims.main(tables)


def test_the_check_prints_every_claim_and_the_totals(capsys):
    check_claims.main(RESULTS)
    text = capsys.readouterr().out
    assert all(f"[{claim.name}]" in text for claim in CLAIMS)
    assert "6 of kind 'chose the readings': 6 holds for exactly these inputs" in text
    assert " of kind 'result': " in text


def test_a_claim_that_holds_in_every_draw_holds(tables):
    """All sliders that are printed alike give the run's numbers: the six hold."""
    for name in ("noise_members", "digits_members"):
        members = pd.read_csv(tables / f"{name}.csv")
        run = members[members["draw"] == 0].set_index("scene")
        for column in ("events_counted", "mu_sapp"):
            members[column] = members["scene"].map(run[column])
        members.to_csv(tables / f"{name}.csv", index=False)
    claims = evaluate(Tables(tables)).set_index("claim")
    assert set(claims["verdict"][claims["kind"] == "chose the readings"]) == {HOLDS}
