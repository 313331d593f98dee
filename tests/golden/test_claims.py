"""The ledger judges the results as they lie there; it is the golden one, and shows a falsified result."""

from __future__ import annotations

import shutil
from pathlib import Path

import pandas as pd
import pytest
from golden.regenerate import GOLDEN

from precursors.cli import main
from precursors.reproduction.ledger.claims import read_claims
from precursors.reproduction.ledger.judge import differences, judge, to_table
from precursors.reproduction.ledger.rules import VERDICTS

ROOT = Path(__file__).parents[2]
RESULTS = ROOT / "results/tables"
CLAIMS = ROOT / "paper/claims.yaml"
CLAIMS_READ = read_claims(CLAIMS)
# Tables and columns that claims are judged by, with these claims.
COLUMNS: dict[tuple[str, str], list[str]] = {}
for claim in CLAIMS_READ:
    for item in (*claim.evidence, *claim.against):
        COLUMNS.setdefault((item.table, item.column), []).append(claim.id)


@pytest.fixture
def tables(tmp_path: Path) -> Path:
    """A copy of the tables without their checksums, to be falsified."""
    return Path(shutil.copytree(RESULTS, tmp_path / "tables"))


def check(tables: Path) -> int:
    """What `make check` does, for the tables of a directory."""
    paths = ("--claims", CLAIMS, "--tables", tables, "--expected", GOLDEN / "claims.csv")
    return main(["check", "--full", *map(str, paths)])


def falsify(path: Path, column: str, rows: slice | list[int] = slice(None)) -> None:
    table = pd.read_csv(path)
    values = table[column].iloc[rows]
    numbers = pd.to_numeric(values, errors="coerce")
    falsified = ~values if values.dtype == bool else 1 - 3 * numbers
    table[column] = table[column].astype(object)
    table.loc[values.index, column] = falsified
    table.to_csv(path, index=False)


def test_the_ledger_is_the_golden_one(capsys):
    assert check(RESULTS) == 0, capsys.readouterr().err


def test_the_ledger_has_every_verdict():
    verdicts = pd.read_csv(GOLDEN / "claims.csv")["verdict"]
    assert set(verdicts) == set(VERDICTS)


@pytest.mark.parametrize(("table", "column"), COLUMNS)
def test_no_column_that_a_claim_is_judged_by_can_be_falsified_unseen(tables, table, column):
    falsify(tables / f"{table}.csv", column)
    judged = [claim for claim in CLAIMS_READ if claim.id in COLUMNS[table, column]]
    ledger = pd.read_csv(tables / "claims.csv", dtype=str, keep_default_na=False)
    before = ledger[ledger["id"].isin(COLUMNS[table, column])]
    assert differences(to_table(judge(judged, tables)), before, same_processor=True)


@pytest.mark.parametrize(
    ("table", "column", "row", "name"),
    [
        ("reproduction", "reproduced", 0, "count-uniform"),
        ("fig12_slips", "kept", 3, "count-leading"),
        ("fig10_slips", "is_global", 3, "load-of-the-experiment"),
        ("mu_sapp", "mu_sapp", 0, "friction-uniform"),
        ("fig11_slips", "end_s", 6, "slip-duration-of-the-experiment"),
        ("eq15", "holds", 5, "eq13"),
    ],
)
def test_one_falsified_number_makes_the_check_fail(tables, capsys, table, column, row, name):
    falsify(tables / f"{table}.csv", column, [row])
    assert check(tables) == 1
    assert f"precursors check: {name}: " in capsys.readouterr().err


def test_a_ledger_that_was_edited_makes_the_check_fail(tables, capsys):
    path = tables / "claims.csv"
    path.write_text(
        path.read_text(encoding="utf-8").replace("not reproduced", "reproduced"), encoding="utf-8"
    )
    assert check(tables) == 1
    assert "verdict is 'not reproduced', expected 'reproduced'" in capsys.readouterr().err


def test_fragile_comes_from_the_spread(tables):
    def verdict() -> str:
        [judgement] = judge([claim for claim in CLAIMS_READ if claim.id == "count-leading"], tables)
        return judgement.verdict

    assert verdict() == "reproduced but fragile"
    path = tables / "robustness.csv"
    pd.read_csv(path).assign(**{"class": "robust"}).to_csv(path, index=False)
    assert verdict() == "reproduced"
