"""A committed table is what its rule made, and a build says which row is not."""

import hashlib

import pandas as pd
import pytest

from maegawa2010.paper.committed import (
    agreement,
    compared,
    hand_on,
    provenance_table,
)

ROW = ["load", "n_blocks"]
TABLE = pd.DataFrame(
    {
        "load": ["even", "even", "notch"],
        "n_blocks": [20, 40, 20],
        "q50": [0.46, 0.45, 0.47],
        "first": [0.461, 0.452, None],
    }
)
MADE = TABLE[::-1]  # rows are found by their names


def compared_with(made=MADE, committed=TABLE):
    return compared("balance_loads", committed, made, ROW, {"first": 1e-4})


@pytest.fixture
def published(tmp_path):
    """The committed table, and where it comes from."""
    table, provenance = tmp_path / "balance_loads.csv", tmp_path / "provenance.csv"
    TABLE.to_csv(table, index=False)
    origins = {"balance_loads": ("tabulate_long_balance", 2019)}
    provenance_table([str(table)], origins, "0123abc").to_csv(provenance, index=False)
    return table, provenance


def handed_on(published, comparison):
    table, provenance = published
    output = {
        name: table.parent / f"{name}_out.csv" for name in (table.stem, "committed")
    }
    hand_on(comparison, [str(table)], str(provenance), output)
    return [path.read_bytes() for path in output.values()]


def test_a_table_whose_beginnings_are_made_alike_is_handed_on(published):
    table, provenance = published
    copy, comparison = handed_on(published, compared_with())
    assert copy == table.read_bytes()
    assert b"line 3, load = even, n_blocks = 40" in comparison
    assert (
        agreement(compared_with())
        == "3 numbers of 1 committed tables were made again, and all agree"
    )
    (origin,) = pd.read_csv(provenance).to_dict("records")
    digest = hashlib.sha256(table.read_bytes()).hexdigest()
    assert list(origin.values())[1:] == [
        "tabulate_long_balance",
        "0123abc",
        2019,
        digest,
    ]


@pytest.mark.parametrize("number", [0.4522, None])
def test_a_row_that_differs_is_named_with_both_numbers(published, number):
    made = MADE.assign(first=[None, number, 0.461])
    line = (
        r"balance_loads\.csv, line 3, load = even, n_blocks = 40: first is 0\.452, and"
    )
    with pytest.raises(ValueError, match=line):
        handed_on(published, compared_with(made))


def test_a_row_that_is_missing_is_named():
    line = "balance_loads.csv has no load = even, n_blocks = 40"
    with pytest.raises(ValueError, match=line):
        compared_with(committed=TABLE.drop(index=1))


def test_a_median_that_was_changed_by_hand_is_refused(published):
    table, _ = published
    table.write_text(table.read_text().replace("0.47", "0.45"))
    with pytest.raises(ValueError, match=r"loads\.csv does not have the checksum"):
        handed_on(published, compared_with())
