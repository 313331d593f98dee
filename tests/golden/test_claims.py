"""The verdicts on the existing results are the golden ones, and a falsified result changes them."""

from __future__ import annotations

import shutil
from pathlib import Path

import check_claims
import pandas as pd
import pytest
from golden.regenerate import GOLDEN

from precursors.reproduction.claim import NOT_COMPUTED, VERDICTS
from precursors.reproduction.claims import CLAIMS, TABLES, evaluate
from precursors.reproduction.tables import Tables

RESULTS = Path(__file__).parents[2] / "results/tables"
EXPECTED = pd.read_csv(GOLDEN / "claims.csv", dtype=str, keep_default_na=False).set_index("id")
# Lyapunov exponents differ from one processor to another: the verdict stays.
VARY = ["chaos"]


@pytest.fixture
def tables(tmp_path: Path) -> Path:
    """A copy of the tables, to be falsified."""
    for name in TABLES:
        shutil.copy(RESULTS / f"{name}.csv", tmp_path)
    return tmp_path


def falsified(column: pd.Series) -> pd.Series:
    """Other numbers and flags; texts as they are, apart from numbers among them."""
    if column.dtype == bool:
        return ~column
    numbers = pd.to_numeric(column, errors="coerce")
    # Not the same change in each column, as some claims compare two.
    return column.where(numbers.isna(), (1 - len(str(column.name)) * numbers).astype(object))


def falsify(path: Path, column: str, row: int | None = None) -> None:
    table = pd.read_csv(path)
    other = falsified(table[column])
    table[column] = other if row is None else table[column].where(table.index != row, other)
    table.to_csv(path, index=False)


def test_claims_and_numbers_are_the_golden_ones():
    found = evaluate(Tables(RESULTS)).set_index("id")
    pd.testing.assert_series_equal(found["verdict"], EXPECTED["verdict"])
    stable = ["where", "kind", "statement", "unit", "paper", "ours", "rule"]
    pd.testing.assert_frame_equal(found[stable].drop(VARY), EXPECTED[stable].drop(VARY))


def test_the_table_of_claims_is_what_the_tables_give():
    written = pd.read_csv(RESULTS / "claims.csv", dtype=str, keep_default_na=False)
    pd.testing.assert_frame_equal(evaluate(Tables(RESULTS)), written, check_dtype=False)


def test_every_verdict_occurs():
    assert set(EXPECTED["verdict"]) == set(VERDICTS)


def test_the_claims_use_the_tables_that_the_workflow_gives_them_and_no_other():
    tables = Tables(RESULTS)
    evaluate(tables)
    assert set(tables) == set(TABLES)


def test_no_claim_stays_the_same_on_other_numbers():
    true, false = Tables(RESULTS), Tables(RESULTS)
    for name in TABLES:
        false[name] = true[name].apply(falsified)

    def found(claim, tables):
        try:
            return [*claim.find(tables).ours, *claim.find(tables).paper]
        except (ValueError, IndexError, ZeroDivisionError):
            return None

    same = {claim.id for claim in CLAIMS if found(claim, true) == found(claim, false)}
    not_computed = set(EXPECTED.index[EXPECTED["verdict"] == NOT_COMPUTED])
    # Two names of one thing change no number.
    assert same == not_computed | {"two-names"}


@pytest.mark.parametrize(
    ("table", "column", "row", "name"),
    [
        ("fig10_slips", "counted", 0, "count-uniform"),
        ("fig12_slips", "counted", 3, "count-leading"),
        ("fig10_slips", "is_global", 3, "load-of-the-experiment"),
        ("mu_sapp", "mu_sapp", 0, "friction-uniform"),
        ("fig11_slips", "n_slid", 6, "vertical-lines"),
        ("fig10_trace", "tangential_load_N", 0, "start"),
        ("measures", "share_of_events_from_block_1", 0, "trailing-edge"),
        ("definitions", "numbers_within_a_digit", None, "readings"),
        ("lyapunov", "exponent_per_s", 0, "chaos"),
        ("eq15", "holds", 0, "eq13"),
    ],
)
def test_one_falsified_number_makes_the_check_fail(tables, capsys, table, column, row, name):
    falsify(tables / f"{table}.csv", column, row)
    with pytest.raises(SystemExit, match=rf"check: {name}: is "):
        check_claims.main(tables)


def test_the_check_prints_every_claim_and_the_totals(capsys):
    check_claims.main(RESULTS)
    text = capsys.readouterr().out
    assert all(f"[{claim.id}]" in text for claim in CLAIMS)
    assert " of kind result (what the model gives, and could have given otherwise): " in text


def test_fragile_comes_from_the_spread(tables):
    path = tables / "robustness.csv"
    pd.read_csv(path).assign(**{"class": "robust"}).to_csv(path, index=False)
    assert "reproduced but fragile" not in set(evaluate(Tables(tables))["verdict"])
