"""The tables of results/tables: CSV files that keep every digit."""

from __future__ import annotations

from pathlib import Path

import pandas as pd

from precursors.storage import open_checked, write_checked


def read_table(path: str | Path) -> pd.DataFrame:
    """Read a table of results/tables with every digit of its numbers.

    Raises
    ------
    ValueError
        If it is not as `write_table` left it, or no table.
    """
    try:
        return pd.read_csv(open_checked(path))
    except (ValueError, RecursionError, OverflowError) as error:
        raise ValueError(f"{path}: {error}") from None


def write_table(table: pd.DataFrame, path: str | Path) -> None:
    """Write a table of results/tables with every digit of its numbers, whole, and its checksum."""
    with write_checked(path) as temporary:
        table.to_csv(temporary, index=False, lineterminator="\n")
