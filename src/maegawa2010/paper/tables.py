"""The workflow's tables by name, and selection of their rows."""

from collections.abc import Mapping
from typing import Any

import pandas as pd

from precursors.analysis.slips import until_global

Tables = Mapping[str, pd.DataFrame]


def rows(table: pd.DataFrame, **where: Any) -> pd.DataFrame:
    """Rows with given values in given columns."""
    for column, value in where.items():
        table = table[table[column] == value]
    return table


def cell(table: pd.DataFrame, column: str, **where: Any) -> Any:
    """The value of a column in the only row with the values in `where`.

    Raises
    ------
    IndexError
        If there is not exactly one such row.
    """
    values = rows(table, **where)[column]
    if len(values) != 1:
        chosen = ", ".join(f"{name} = {value}" for name, value in where.items())
        raise IndexError(f"{len(values)} rows have {chosen}, but one must")
    return values.iloc[0]


def before_global(tables: Tables, scene: str) -> pd.DataFrame:
    """Slip events of a scene before its first global slip: the precursors, including
    short ones."""
    slips = tables[f"{scene}_slips"]
    is_global = slips["is_global"]
    return slips[until_global(is_global) & ~is_global]
