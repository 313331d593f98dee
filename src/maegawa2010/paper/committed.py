"""Committed tables of long studies.

provenance.csv has the rule, commit and seed that made each table. Every build makes a
part of each row again and compares it.
"""

import hashlib
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from precursors.support.files import read_bytes, read_table, write_table, write_whole

REMEDY = "if the code is right, run make article"


def compared(
    name: str,
    committed: pd.DataFrame,
    made: pd.DataFrame | Sequence[Mapping[Any, Any]],
    row: Sequence[str],
    tolerances: Mapping[str, Any],
) -> pd.DataFrame:
    """Compare a committed table with rows of it that were made again.

    The columns `row` identify a row in both tables. `tolerances` gives each compared
    column a tolerance, or one for each row of `made`.

    Returns
    -------
    DataFrame
        One row per number: table, row, quantity, committed, made, tolerance, agrees.

    Raises
    ------
    ValueError
        In one line: the committed table lacks a row.
    """
    row, made = list(row), pd.DataFrame(made)
    there = made[row].merge(committed.reset_index(names="line"), how="left", on=row)
    names = [row_name(values) for values in there[["line", *row]].to_dict("records")]
    for values, lacks in zip(names, there["line"].isna(), strict=True):
        if lacks:
            raise ValueError(f"paper/tables/{name}.csv has no {values}: {REMEDY}")
    parts = []
    for column, tolerance in tolerances.items():
        old, new = (table[column].astype(float).to_numpy() for table in (there, made))
        neither = np.isnan(old) & np.isnan(new)
        part: dict[str, Any] = {"table": name, "row": names, "quantity": column}
        part |= {"committed": old, "made": new, "tolerance": tolerance}
        part["agrees"] = neither | (np.abs(new - old) <= tolerance)
        parts.append(pd.DataFrame(part))
    return pd.concat(parts, ignore_index=True)


def row_name(values: Mapping[Any, Any]) -> str:
    """Name a row of a file, such as "line 3, scene = fig11, n_blocks = 10"."""
    shown = {name: value for name, value in values.items() if not pd.isna(value)}
    line = shown.pop("line", None)
    texts = [
        f"{name} = {value:.4g}" if isinstance(value, float) else f"{name} = {value}"
        for name, value in shown.items()
    ]
    if line is not None:
        texts.insert(0, f"line {int(line) + 2}")
    return ", ".join(texts)


def hand_on(
    comparison: pd.DataFrame, committed: Iterable[str], provenance: str, output: Any
) -> None:
    """Copy committed tables to the outputs of their names, and write the comparison.

    Raises
    ------
    ValueError
        In one line: a row or the checksum of a table differs from the committed one.
    """
    for wrong in comparison[~comparison["agrees"]].itertuples():
        raise ValueError(
            f"paper/tables/{wrong.table}.csv, {wrong.row}: {wrong.quantity} is"
            f" {wrong.committed:.9g}, and this code gives {wrong.made:.9g}: {REMEDY}"
        )
    sums = read_table(provenance).set_index("table")["sha256"]
    for path in map(Path, committed):
        content = read_bytes(path)
        if hashlib.sha256(content).hexdigest() != sums.get(path.stem):
            raise ValueError(
                f"{path} does not have the checksum in provenance.csv: restore it, or run"
                " make article"
            )
        write_whole(output[path.stem], content)
    write_table(comparison, output["committed"])


def provenance_table(
    tables: Iterable[str], origins: Mapping[str, tuple[str, Any]], commit: str
) -> pd.DataFrame:
    """Origin of each table: its rule, commit, seed (if any) and checksum.

    `origins` has rule and seed by the name of the table.
    """
    return pd.DataFrame(
        {
            "table": path.stem,
            "rule": origins[path.stem][0],
            "commit": commit,
            "seed": origins[path.stem][1],
            "sha256": hashlib.sha256(read_bytes(path)).hexdigest(),
        }
        for path in map(Path, tables)
    )


def agreement(comparison: pd.DataFrame) -> str:
    """Say how many numbers of committed tables were made again, and how many agree."""
    n, agree = len(comparison), int(comparison["agrees"].sum())
    tables = comparison["table"].nunique()
    verdict = "all agree" if agree == n else f"{n - agree} differ"
    return f"{n} numbers of {tables} committed tables were made again, and {verdict}"


def comparisons(tables: str | Path) -> dict[str, pd.DataFrame]:
    """Comparisons with committed tables in a directory of tables, by name."""
    paths = sorted(Path(tables).glob("committed_*.csv"))
    return {path.stem: read_table(path) for path in paths}
