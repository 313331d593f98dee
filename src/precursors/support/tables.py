"""The tables of results/tables: CSV files that keep every digit, each with its checksum beside it."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pandas as pd

from precursors.support.files import open_checked, write_checked


def read_table(path: str | Path, columns: Mapping[str, type] | None = None, **how: Any) -> pd.DataFrame:
    """Read a table with every digit of its numbers.

    Parameters
    ----------
    path : path
        The file.
    columns : mapping of str to type
        Columns that are needed, and what they hold; there may be others.
    **how
        As for `pandas.read_csv`.

    Raises
    ------
    OSError
        If the file cannot be read.
    ValueError
        If it is not as `write_table` left it, or no table, or a column is missing or holds something else.
    """
    checked = open_checked(path)
    try:
        table = pd.read_csv(checked, **how)
    except (ValueError, RecursionError, OverflowError) as error:
        raise ValueError(f"{path} is no table: {' '.join(str(error).split())}") from None
    columns = columns or {}
    missing = [name for name in columns if name not in table.columns]
    if missing:
        raise ValueError(f"{path}: column {missing[0]} is missing: needed are {', '.join(columns)}")
    try:
        return table.astype(columns)
    except (TypeError, ValueError) as error:
        raise ValueError(f"{path}: {error}") from None


def write_table(table: pd.DataFrame, path: str | Path) -> None:
    """Write a table with every digit of its numbers, whole, and its checksum."""
    with write_checked(path) as temporary:
        table.to_csv(temporary, index=False, lineterminator="\n")
