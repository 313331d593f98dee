"""The tables of results/tables: CSV files that keep every digit."""

from __future__ import annotations

from pathlib import Path

import pandas as pd

from precursors.storage import write_atomically


def read_table(path: str | Path) -> pd.DataFrame:
    """Read a table of results/tables with every digit of its numbers."""
    return pd.read_csv(path)


def write_table(table: pd.DataFrame, path: str | Path) -> None:
    """Write a table of results/tables with every digit of its numbers, whole or not at all."""
    with write_atomically(path) as temporary:
        table.to_csv(temporary, index=False, lineterminator="\n")
