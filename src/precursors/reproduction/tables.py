"""The tables of a directory by name, and rows of them."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import pandas as pd

from precursors.analysis.slip_rows import first_global, up_to_first_global
from precursors.support.files import read_table


class Tables(dict[str, pd.DataFrame]):
    """Tables of a directory by name; each is read when it is first asked for.

    Raises
    ------
    FileNotFoundError
        If there is no such table.
    """

    def __init__(self, directory: str | os.PathLike[str]) -> None:
        super().__init__()
        self.directory = Path(directory)

    def __missing__(self, name: str) -> pd.DataFrame:
        path = self.directory / f"{name}.csv"
        if not path.is_file():
            raise FileNotFoundError(f"{path} is missing: the workflow writes it")
        self[name] = read_table(path)
        return self[name]


def rows(table: pd.DataFrame, **where: Any) -> pd.DataFrame:
    """Rows that have these values in these columns; of a list, any of its values."""
    for column, value in where.items():
        table = table[table[column].isin(value if isinstance(value, list) else [value])]
    return table


def one(table: pd.DataFrame, column: str, **where: Any) -> Any:
    """The value of a column in the only row that is as in `where`.

    Raises
    ------
    IndexError
        If there is not exactly one such row.
    """
    found = rows(table, **where)[column]
    if len(found) != 1:
        chosen = ", ".join(f"{name} = {value}" for name, value in where.items())
        raise IndexError(f"{len(found)} rows have {chosen}: needed is one")
    return found.iloc[0]


def up_to_global(tables: Tables, scene: str) -> pd.DataFrame:
    """Slip events of a scene up to and including the first global slip."""
    return up_to_first_global(tables[f"{scene}_slips"])


def before_global(tables: Tables, scene: str) -> pd.DataFrame:
    """Slip events of a scene before the first global slip: its precursors, short ones included."""
    slips = tables[f"{scene}_slips"]
    return slips.iloc[: first_global(slips)]
