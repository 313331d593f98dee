"""Tables of numbers as spreadsheets and instruments write them: read whole, or refused."""

from __future__ import annotations

import csv
import io
import math
import re
import warnings
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from itertools import chain, zip_longest
from os import PathLike
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from precursors.support.files import AnyPath, read_bytes
from precursors.support.units import (
    LENGTH,
    LOAD,
    NAMES,
    NORMAL_LOAD,
    PROFILE,
    TIME,
    Wanted,
    factor,
    parts_of,
    rank,
)

if TYPE_CHECKING:
    import pandas as pd

__all__ = ["LENGTH", "LOAD", "TIME", "read_columns", "read_profile", "read_weights"]

NUMBER = re.compile(r"[-+]?(\d+(\.\d*|,\d+)?|[.,]\d+)([eE][-+]?\d{1,3})?")
# A number, or three more digits.
THOUSANDS = re.compile(r"[-+]?[1-9]\d{0,2}(,\d{3})+")
# A date or none, hours, minutes, seconds.
STAMP = re.compile(
    r"(?:(\S+)[ T])?(\d{1,2}):(\d\d):(\d\d(?:[.,]\d*)?)(?:Z|[-+][\d:]+)?"
)
DAY = 86_400.0  # [s]
# What stands where a number is missing, as #N/A and #DIV/0! in a spreadsheet.
MISSING = re.compile(r"#(N/A|NV|[A-Z/0]+[!?])|[-+]?(nan|inf)|n/?a|null", re.IGNORECASE)
SEPARATOR = re.compile(r'"?sep=(.)"?', re.IGNORECASE)
HAS_WORD = re.compile(r"\w")
NOTHING = "\x1f"  # stands in no table: there is one column
UNITS_ABOVE = re.compile(
    r".*(unit|einheit)", re.IGNORECASE
)  # as LabVIEW's Y_Unit_Label

Row = tuple[int, list[str]]  # number of its line, cells
Numbers = NDArray[np.float64]


class Table(NamedTuple):
    """A table of text; each row has a field for each name."""

    path: str  # or what else it is called
    separator: str
    lines: Sequence[int]
    names: Sequence[str]
    columns: Sequence[Sequence[str]]


def read_columns(
    source: AnyPath | pd.DataFrame,
    needed: Sequence[str],
    sample_rate: float | None = None,
    choice: Mapping[str, str] | None = None,
    length: float | None = None,
) -> Numbers:
    """Read columns of numbers, which are found by their names and units.

    Lines above the names are passed over, and those that begin with # or %. Values are
    converted to the unit needed. A warning tells which column is converted or known by
    its unit alone, and how many rows lack a value.

    Parameters
    ----------
    source : path or DataFrame
        The table.
    needed : sequence of str
        Which columns, keys of `NAMES`.
    sample_rate : float, optional
        Lines per second [Hz], for a table without times.
    choice : dict, optional
        Names of columns by their symbols t, F_X, L_p; in a table without names, numbers.
    length : float, optional
        Length of the slider [m], for front lengths in metres.

    Returns
    -------
    ndarray, shape (number of rows, number of columns)
        In the order of `needed`.

    Raises
    ------
    OSError
        If the file cannot be read.
    ValueError
        In one line with file, line, and what is needed.
    """
    kinds = [kind for kind in needed if kind != TIME or sample_rate is None]
    wanted = Wanted(kinds, choice or {}, length)

    def read(table: Table, notes: list[str]) -> Numbers:
        chosen = _chosen(table, wanted)
        rows = list(zip(table.lines, *chosen.columns, strict=True))
        kept = [row for row in rows if all(row)]
        if not kept:
            raise ValueError(f"{table.path} has no numbers")
        if missing := len(rows) - len(kept):
            notes.append(f"rows without a value: {missing}")
        lines, *columns = zip(*kept, strict=True)
        numbers = _numbers(chosen._replace(lines=lines, columns=columns), wanted, notes)
        if sample_rate is None:
            return numbers
        start = table.lines[0]
        if len(rows) <= table.lines[-1] - start:
            raise ValueError(
                f"{table.path}: with a sample rate, no line may stand empty between samples"
            )
        return np.column_stack([(np.array(lines) - start) / sample_rate, numbers])

    return _read(source, wanted, read)


def read_weights(path: AnyPath, choice: Mapping[str, str] | None = None) -> list[float]:
    """Normal loads [N], a number for each block, alone or after the number or name of
    the block: 1 or b1, 2 or b2. `choice` may have the name of their column as w."""
    wanted = Wanted([NORMAL_LOAD], choice or {})

    def read(table: Table, notes: list[str]) -> Numbers:
        names = table.names
        in_a_row = not any(names) or _number_blocks([parts_of(n).words for n in names])
        if len(table.lines) == 1 and len(names) > 2 and in_a_row:  # as of the explorer
            table = _turned(table)
        elif len(names) > 1 and "w" not in wanted.choice:
            if not _number_blocks(table.columns[0]):
                raise ValueError(
                    f"{path}: columns: {len(names)}; needed: {NORMAL_LOAD}, one a line, "
                    "alone or after the number of its block, 1, 2, 3, ..., or chosen with "
                    '--columns "w=NAME"'
                )
            table = table._replace(names=names[1:], columns=table.columns[1:])
        return _numbers(_chosen(table, wanted), wanted, notes)

    return [float(load) for [load] in _read(path, wanted, read)]


def read_profile(path: AnyPath, choice: Mapping[str, str] | None = None) -> Numbers:
    """The shape of a pressure or load in any unit, a line for each position from the
    trailing edge on: a column, or a matrix without names. `choice` may have the name of
    the column as p."""
    wanted = Wanted([PROFILE], choice or {})

    def read(table: Table, _: list[str]) -> Numbers:
        is_one = len(table.columns) == 1 or "p" in wanted.choice
        table = _chosen(table, wanted) if is_one else table
        numbers = _values(table, [PROFILE] * len(table.columns))
        steps = np.diff(numbers[:, 0])
        has_positions = len(steps) > 1 and 0 < steps.max() < 1.0001 * steps.min()
        if not is_one and (any(table.names) or has_positions):
            raise ValueError(
                f"{path}: columns: {len(table.columns)}; needed: one column, or a matrix "
                'without names and positions, or one chosen with --columns "p=NAME"'
            )
        if len(numbers) == 1:
            raise ValueError(f"{path}: needed is a line for each position, not one")
        return numbers

    return _read(path, wanted, read)


def _read(
    source: AnyPath | pd.DataFrame,
    wanted: Wanted,
    read: Callable[[Table, list[str]], Numbers],
) -> Numbers:
    """Numbers of a table. Where a comma may separate columns or stand in a number, the
    table is refused."""
    if isinstance(source, (str, PathLike)):
        path = str(source)
        text = _text(source)
        separators = _separators(text)
    else:
        path = "data"
        has_names = all(isinstance(name, str) for name in source.columns)
        text = source.to_csv(sep=";", index=False, header=has_names)
        separators = ";"  # which stand in no number
    readings: dict[str, tuple[Numbers, list[str]]] = {}
    refusals: list[ValueError] = []
    commas_separate = False
    for separator in separators:
        notes: list[str] = []
        try:
            names, body = _names(_rows(path, text, separator), wanted)
            if len(names) == 1 and separator != separators[-1]:
                continue  # commas that stand in numbers
            table = _table(path, separator, names, body)
            if separator == "," and len(table.columns) > 1:
                commas_separate = all(_are_values(fields) for fields in table.columns)
            readings[separator] = read(table, notes), notes
        except ValueError as refusal:
            refusals.append(refusal)
    if not readings:
        raise refusals[0]
    if commas_separate and readings.keys() - {","}:
        raise ValueError(
            f"{path}: a comma may separate two numbers or be a decimal comma: separate "
            "columns by semicolons, or write decimal points"
        )
    numbers, notes = next(iter(readings.values()))
    for note in notes:
        warnings.warn(f"{path}: {note}", stacklevel=3)
    return numbers


def _text(path: AnyPath) -> str:
    content = read_bytes(path)
    if b"\0" in content:
        raise ValueError(
            f"{path} is not plain text: in the spreadsheet, save the table as CSV (UTF-8)"
        )
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError:  # names in other letters are not known then
        return content.decode("latin-1")


def _separators(text: str) -> str:
    """What may separate columns, by the last line, which has no names."""
    if declared := SEPARATOR.match(text):
        return declared[1]
    last = next(filter(HAS_WORD.search, reversed(text.splitlines())), "").strip()
    if ";" in last or "\t" in last:
        return ";" if ";" in last else "\t"
    other = " " if " " in last else NOTHING
    return f",{other}" if "," in last else other


def _rows(path: str, text: str, separator: str) -> list[Row]:
    """Rows that are not empty, without blanks around their cells and empty cells at the
    end."""
    lines = io.StringIO(text, newline="")
    if separator == " ":
        blank = re.compile(r"(?<![#%])[ \t]+(?![\[(])")
        cut = (blank.split(line.strip()) for line in lines)
        rows = [
            (n, [cell.strip('" ') for cell in cells]) for n, cells in enumerate(cut, 1)
        ]
    else:
        reader = csv.reader(
            lines, delimiter=separator, skipinitialspace=True, strict=True
        )
        try:
            rows = [(reader.line_num, list(map(str.strip, cells))) for cells in reader]
        except csv.Error as error:
            raise ValueError(f"{path} is not a table: {error}") from None
    for _, cells in rows:
        while cells and not cells[-1].strip(';,\t"'):
            cells.pop()
    return [row for row in rows if row[1] and not row[1][0].lower().startswith("sep=")]


def _table(path: str, separator: str, names: list[str], body: list[Row]) -> Table:
    """A table without its empty columns; no row has a cell beside the names."""
    if not body:
        raise ValueError(f"{path} has no numbers")
    width = len(names)
    for line, cells in body:
        if len(cells) > width or (separator == " " and len(cells) < width):
            raise ValueError(
                f"{path}, line {line}: cells: {len(cells)}, columns: {width} (are there "
                "decimal commas, or names with blanks?)"
            )
    lines, filled = zip(*body, strict=True)
    columns = zip_longest(names, *filled, fillvalue="")
    kept = [(name, fields) for name, *fields in columns if any(fields)]
    return Table(path, separator, lines, *zip(*kept, strict=True))


def _names(rows: list[Row], wanted: Wanted) -> tuple[list[str], list[Row]]:
    """Names of the columns and the rows below: of the first line that names what is
    wanted, or else of the last above all numbers; or empty."""
    above: list[str] = []
    for i, (_, cells) in enumerate(rows):
        if _are_values(cells):
            break
        if UNITS_ABOVE.match(cells[0]):
            above = ["", *cells[1:]]
        if any(map(_is_value, cells)):
            continue
        names = [cells[0].lstrip("#% "), *cells[1:]]
        below = rows[i + 1 :]
        if below and _are_units(below[0][1], names):
            names = _with_units(names, below.pop(0)[1])
        elif above:
            names = _with_units(names, above)
        with suppress(ValueError):
            wanted.places(names)
            return names, [row for row in below if not _is_comment(row)]
    body = [row for row in rows if not _is_comment(row)]
    numeric = (i for i, (_, cells) in enumerate(body) if _are_values(cells))
    partly = (i for i, (_, cells) in enumerate(body) if any(map(_is_value, cells)))
    first = next(chain(numeric, partly), len(body))
    if first:
        return _with_units(body[first - 1][1], above), body[first:]
    return [""] * len(body[0][1]) if body else [], body


def _are_units(cells: list[str], names: list[str]) -> bool:
    """Whether a line below names may be that of their units."""
    inside = [cell.strip("#% [({})]") for cell in cells]
    has_brackets = any(set("[({})]") & set(cell) for cell in inside)
    return (
        len(cells) == len(names)
        and not has_brackets
        and not any(map(_is_value, inside))
    )


def _with_units(names: Sequence[str], units: Sequence[str]) -> list[str]:
    units = [unit.strip("#% [({})]") for unit in units]
    return [
        f"{name} [{unit}]" if unit else name
        for name, unit in zip_longest(names, units, fillvalue="")
    ]


def _is_comment(row: Row) -> bool:
    return row[1][0][0] in "#%" and not MISSING.fullmatch(row[1][0])


def _number_blocks(labels: Sequence[str]) -> bool:
    """Whether labels such as b1 or Block 1 number all blocks in order."""
    found = (re.fullmatch(r"\D*(\d+)([.,]0*)?", label) for label in labels)
    numbers = [label and int(label[1]) for label in found]
    return numbers == list(range(1, len(labels) + 1))


def _turned(table: Table) -> Table:
    """A table of one row as one of one column."""
    units = sorted({parts_of(name).unit or "" for name in table.names})
    fields = [field for [field] in table.columns]
    lines = [*table.lines] * len(fields)
    names = [f"w [{', '.join(units)}]" if any(units) else "w"]
    return table._replace(lines=lines, names=names, columns=[fields])


def _is_value(cell: str) -> bool:
    """Whether a cell is a number, a time, or an error in place of them."""
    kinds = (NUMBER, STAMP, MISSING)
    return any(kind.fullmatch(cell) for kind in kinds)


def _are_values(cells: Sequence[str]) -> bool:
    return all(not cell or _is_value(cell) for cell in cells)


def _chosen(table: Table, wanted: Wanted) -> Table:
    """The columns of a table that are wanted."""
    try:
        places = wanted.places(table.names)
    except ValueError as error:
        raise ValueError(f"{table.path}: {error}") from None
    names = [table.names[i] for i in places]
    columns = [table.columns[i] for i in places]
    return table._replace(names=names, columns=columns)


def _numbers(table: Table, wanted: Wanted, notes: list[str]) -> Numbers:
    """Numbers of the columns that are wanted, in their units."""
    scales = []
    for name, fields, kind in zip(
        table.names, table.columns, wanted.kinds, strict=True
    ):
        scale = factor(parts_of(name), kind, wanted.length)
        if kind == TIME and all(map(STAMP.fullmatch, fields)):
            scale = 1.0
        if scale is None:
            unit = parts_of(name).unit or "no unit"
            raise ValueError(
                f"{table.path}: the column {name!r} is in {unit}; needed: {kind}"
            )
        known = rank(name, kind, wanted.length)
        if name and (scale != 1.0 or known in (None, len(NAMES[kind]))):
            notes.append(f"{kind} is read from {name!r}")
        scales.append(scale)
    return _values(table, wanted.kinds) * scales


def _values(table: Table, kinds: Sequence[str]) -> Numbers:
    """Numbers as they are written, with decimal commas or points; of time stamps,
    seconds since the first."""
    fields = [field for column in table.columns for field in column if ":" not in field]
    with_commas = [field for field in fields if "," in field]
    if with_commas and any("." in field for field in fields):
        raise ValueError(
            f"{table.path} has decimal commas and decimal points: write one"
        )
    in_thousands = with_commas and all(map(THOUSANDS.fullmatch, with_commas))
    if in_thousands and table.separator not in ";\t":
        raise ValueError(
            f"{table.path}: {with_commas[0]!r} may have a decimal comma or be in "
            "thousands: write decimal points"
        )
    columns = zip(table.columns, kinds, strict=True)
    return np.column_stack([_column(table, *column) for column in columns])


def _column(table: Table, fields: Sequence[str], kind: str) -> Numbers:
    stamps = [found.groups() for f in fields if (found := STAMP.fullmatch(f))]
    if kind == TIME and len(stamps) == len(fields):
        return _seconds(table.path, stamps)
    at = zip(table.lines, fields, strict=True)
    return np.array([_number(table.path, line, field) for line, field in at])


def _seconds(path: str, stamps: Sequence[tuple[str, ...]]) -> Numbers:
    """Seconds since the first of time stamps less than half a day apart."""
    dates, *clock = zip(*stamps, strict=True)
    hours, minutes, seconds = (
        np.char.replace(part, ",", ".").astype(float) for part in clock
    )
    times = np.unwrap(3600 * hours + 60 * minutes + seconds, period=DAY)
    if any(dates) and len(set(dates)) != len(set(times // DAY)):
        raise ValueError(f"{path}: half a day or more between two time stamps")
    return times - times[0]


def _number(path: str, line: int, field: str) -> float:
    """The number that a field holds."""
    value = field.replace(",", ".")
    if NUMBER.fullmatch(field) and math.isfinite(float(value)):
        return float(value)
    raise ValueError(
        f"{path}, line {line}: {field[:40]!r} is not a number "
        "(write it without a unit and separators of thousands)"
    )
