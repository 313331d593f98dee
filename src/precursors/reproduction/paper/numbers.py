"""The numbers of the paper: each has a name, and a place that it is read from in results or configuration."""

from __future__ import annotations

import itertools
import json
import os
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, fields
from pathlib import Path
from typing import TYPE_CHECKING, Any

from precursors.model.plain_yaml import read_yaml
from precursors.reproduction.ledger.rules import ROWS, TAKES
from precursors.support.files import write_whole

if TYPE_CHECKING:
    import pandas as pd

Value = float | int | str
# One row is meant, and must be the only one.
ONLY = "only"


class PaperError(ValueError):
    """A number or page of the paper that cannot be made: which, what is wrong, and what is allowed."""


@dataclass(frozen=True)
class Source:
    """Where a number comes from: rows of a column of a table, or a key of the configuration.

    Attributes
    ----------
    name : str
        What the text calls it.
    unit : str
        Unit of the value in its source; the text converts it.
    table, column : str
        results/tables/{table}.csv, and its column.
    minus, over : str
        A second column, which is subtracted or divided by.
    rows : str
        A key of `precursors.reproduction.ledger.rules.ROWS`.
    where : tuple of (str, value)
        Columns and the value, or list of values, that these rows must have in them.
    take : str
        "only", for the only row that is left, or a key of `precursors.reproduction.ledger.rules.TAKES`.
    part : int or None
        Which part, from 1, of a text whose parts are separated by semicolons.
    config : str
        In place of a table: the key of the configuration, with a point between levels.
    optional : bool
        Whether there is no such number, instead of an error, where the table has no row.
    """

    name: str
    unit: str = "1"
    table: str = ""
    column: str = ""
    minus: str = ""
    over: str = ""
    rows: str = "all"
    where: tuple[tuple[str, Any], ...] = ()
    take: str = ONLY
    part: int | None = None
    config: str = ""
    optional: bool = False

    @property
    def place(self) -> str:
        """File and column, or key."""
        return (
            f"config.yaml, {self.config}"
            if self.config
            else f"results/tables/{self.table}.csv, {self.column}"
        )


@dataclass(frozen=True)
class Number:
    """A value with its unit and the place that it was read from."""

    value: Value
    unit: str
    source: str


_KEYS = [field.name for field in fields(Source) if field.name != "name"]


def read_sources(path: str | os.PathLike[str]) -> list[Source]:
    """Read where the numbers come from (paper/numbers.yaml).

    A name with {key} in it stands for as many numbers as `lists` has values for that key; the value replaces
    {key} in all texts of the entry.

    Raises
    ------
    PaperError
        In one line: which entry, what is wrong with it, and what is allowed.
    """
    try:
        content = read_yaml(path)
    except ValueError as error:
        raise PaperError(str(error)) from None
    if not isinstance(content, dict) or set(content) != {"lists", "numbers"}:
        raise PaperError(f"{path}: allowed are two tables, lists and numbers")
    sources: dict[str, Source] = {}
    for name, entry in content["numbers"].items():
        for source in _sources(f"{path}: {name}", name, entry, content["lists"]):
            if source.name in sources:
                raise PaperError(f"{path}: {source.name}: the name stands twice")
            sources[source.name] = source
    return list(sources.values())


def tables_needed(sources: Iterable[Source]) -> list[str]:
    """Names of the tables that the numbers are read from, each once, in order of first use."""
    return list(dict.fromkeys(source.table for source in sources if source.table))


def is_configured(sources: Iterable[Source], config: Mapping[str, Any]) -> bool:
    """Whether a configuration has every key that a number of the paper is read from."""
    try:
        configured(sources, config)
    except PaperError:
        return False
    return True


def configured(sources: Iterable[Source], config: Mapping[str, Any]) -> dict[str, Value]:
    """Values of the configuration that are numbers of the paper, by their key.

    Raises
    ------
    PaperError
        In one line: a number whose key is missing.
    """
    values = {}
    for source in sources:
        if source.config:
            values[source.config] = _looked_up(source, config)
    return values


def collect_numbers(
    sources: Iterable[Source], tables: str | os.PathLike[str], config: Mapping[str, Value]
) -> dict[str, Number]:
    """Read every number from the tables of a directory as they are now, or from what `configured` gave.

    Raises
    ------
    PaperError
        In one line: a number whose table is missing or damaged, or has no column or row for it, or too many.
    """
    read: dict[str, pd.DataFrame] = {}
    numbers = {}
    for source in sources:
        try:
            value = config[source.config] if source.config else _tabled(source, Path(tables), read)
        except PaperError as error:
            raise PaperError(f"number {source.name}: {error}") from None
        if value is None:
            continue
        numbers[source.name] = Number(value, source.unit, source.place)
    return numbers


def write_numbers(numbers: Mapping[str, Number], path: str | os.PathLike[str]) -> None:
    """Write the numbers as JSON: name -> value, unit and source."""
    content = {name: vars(number) for name, number in sorted(numbers.items())}
    with write_whole(path) as temporary:
        temporary.write_text(
            json.dumps(content, indent=1, ensure_ascii=False, allow_nan=False) + "\n", "utf-8"
        )


def _sources(where: str, name: str, entry: Any, lists: Mapping[str, list[Any]]) -> Iterator[Source]:
    if not isinstance(entry, dict):
        raise PaperError(f"{where} = {entry!r}: allowed is a table of keys and values")
    for key in entry:
        if key not in _KEYS:
            raise PaperError(f"{where}: {key!r} is an unknown key: allowed are {', '.join(_KEYS)}")
    if bool(entry.get("config")) == bool(entry.get("table")) or bool(entry.get("table")) != bool(
        entry.get("column")
    ):
        raise PaperError(f"{where}: needed are a table and its column, or a key of config")
    if entry.get("take", ONLY) not in [ONLY, *TAKES] or entry.get("rows", "all") not in ROWS:
        raise PaperError(
            f"{where}: allowed for take are {', '.join([ONLY, *TAKES])}; for rows {', '.join(ROWS)}"
        )
    used = [key for key in lists if "{" + key + "}" in name]
    for values in itertools.product(*(lists[key] for key in used)):
        filled = _filled({"name": name, **entry}, dict(zip(used, values, strict=True)))
        yield Source(**{**filled, "where": tuple(filled.get("where", {}).items())})


def _filled(value: Any, texts: Mapping[str, str]) -> Any:
    if isinstance(value, dict):
        return {key: _filled(item, texts) for key, item in value.items()}
    if isinstance(value, list):
        return [_filled(item, texts) for item in value]
    if isinstance(value, str):
        for key, text in texts.items():
            value = value.replace("{" + key + "}", str(text))
    return value


def _looked_up(source: Source, config: Mapping[str, Any]) -> Value:
    value: Any = config
    for key in source.config.split("."):
        if not isinstance(value, Mapping) or key not in value:
            raise PaperError(f"number {source.name}: the configuration has no {source.config}")
        value = value[key]
    if isinstance(value, bool) or not isinstance(value, int | float | str):
        raise PaperError(
            f"number {source.name}: {source.config} = {value!r} of the configuration is no number"
        )
    return value


def _tabled(source: Source, directory: Path, read: dict[str, pd.DataFrame]) -> Value | None:
    from precursors.support.files import read_table

    path = directory / f"{source.table}.csv"
    if source.table not in read:
        if not path.is_file():
            raise PaperError(f"{path} is missing: the workflow writes it")
        try:
            read[source.table] = read_table(path)
        except (ValueError, OSError) as error:
            raise PaperError(str(error)) from None
    table = ROWS[source.rows](read[source.table])
    for column, value in source.where:
        table = table[_column(path, table, column).isin(value if isinstance(value, list) else [value])]
    values = _column(path, table, source.column)
    if source.minus:
        values = values - _column(path, table, source.minus)
    if source.over:
        values = values / _column(path, table, source.over)
    if source.optional and len(values) == 0:
        return None
    return _plain(source, path, values)


def _column(path: Path, table: pd.DataFrame, column: str) -> pd.Series:
    if column not in table:
        raise PaperError(f"{path} has no column {column}: it has {', '.join(table.columns)}")
    return table[column]


def _plain(source: Source, path: Path, values: pd.Series) -> Value:
    """One finite number or text of the values that are left."""
    import numpy as np

    chosen = ", ".join(f"{column} = {value}" for column, value in source.where) or "all"
    if source.take == ONLY and len(values) != 1:
        raise PaperError(f"{path} has {len(values)} rows with {chosen}: needed is one")
    if source.take != "count" and len(values) == 0:
        raise PaperError(f"{path} has no row with {chosen}")
    value: Any = values.iloc[0] if source.take == ONLY else TAKES[source.take](values.to_numpy())
    if source.part is not None:
        parts = [part.strip() for part in str(value).split(";")]
        if not 1 <= source.part <= len(parts):
            raise PaperError(f"{path}: {value!r} has {len(parts)} parts: part {source.part} is asked for")
        value = parts[source.part - 1]
    if isinstance(value, str):
        try:
            value = float(value)
        except ValueError:
            return str(value)
    if not np.isfinite(value):
        raise PaperError(f"{path}, column {source.column}, rows {chosen}: {value} is no number")
    return int(value) if float(value).is_integer() and abs(value) < 1e15 else float(value)
