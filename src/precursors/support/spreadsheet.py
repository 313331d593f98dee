"""Tables of numbers as spreadsheets and instruments write them: read whole, or refused."""

from __future__ import annotations

import csv
import io
import math
import re
import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from functools import partial
from itertools import zip_longest
from os import PathLike
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from precursors.support.files import AnyPath, read_bytes
from precursors.support.units import (
    BRACKETS,
    HALF,
    LENGTH,
    LOAD,
    NORMAL_LOAD,
    PROFILE,
    TIME,
    is_unit,
    meaning,
    places,
)

if TYPE_CHECKING:
    import pandas as pd

__all__ = ["LENGTH", "LOAD", "TIME", "read_columns", "read_profile", "read_weights"]

NUMBER = re.compile(r"[-+]?(\d+(\.\d*|,\d+)?|\.\d+)([eE][-+]?\d{1,3})?")
# Which may be a number with a decimal comma, too.
THOUSANDS = re.compile(r"[-+]?[1-9]\d{0,2}(,\d{3})+")
# A date or none, hours, minutes, seconds.
STAMP = re.compile(
    r"(?:(\S+)[ T])?(\d{1,2}):(\d\d):(\d\d(?:[.,]\d*)?)(?:Z|[-+][\d:]+)?"
)
DAY = 86_400.0  # [s]
BLOCK = re.compile(r"[^\d.,+-]*(\d+)([.,]0*)?")  # the number or name of a block
# The first cell of a line of units above names, as LabVIEW's Y_Unit_Label.
UNITS_ABOVE = re.compile(r".*(unit|einheit)", re.IGNORECASE)
PROFILE_NEEDED = (
    "needed: a line for each position, of one column, or a matrix without names and "
    'positions, or a column chosen with --columns "p=NAME"'
)
MOST_ABOVE = 1000  # lines, with that of names
NO_SEPARATOR = "\x1f"  # of a table with one column

Numbers = NDArray[np.float64]
Find = Callable[[Sequence[str]], list[int]]  # places of columns by their names
Row = tuple[int, list[str]]  # number of its line, cells


class Table(NamedTuple):
    """A table of text; each row has a cell for each name."""

    separator: str
    lines: NDArray[np.int_]
    names: list[str]
    cells: Any  # array of strings


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
        Names of columns by t, F_X or L_p/L, or numbers of those without a name.
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
    find = partial(places, kinds, choice, length)
    with _refusals_of(source) as path:
        table = _chosen(_table(source, find), find)
        lines = table.lines
        is_full = (table.cells != "").all(axis=1)
        if not is_full.all():
            warnings.warn(
                f"{path}: rows without a value: {(~is_full).sum()}", stacklevel=2
            )
        full = table._replace(lines=lines[is_full], cells=table.cells[is_full])
        numbers = _numbers(path, full, kinds, length)
        if sample_rate is None:
            return numbers
        if len(lines) <= lines[-1] - lines[0]:
            raise ValueError(
                "with a sample rate, no line may stand empty among samples"
            )
        return np.column_stack([(full.lines - lines[0]) / sample_rate, numbers])


def read_weights(path: AnyPath, choice: Mapping[str, str] | None = None) -> list[float]:
    """Normal loads [N], a number for each block, alone or with the number of the block:
    1 or b1, 2 or b2. `choice` may have the name of their column as w."""
    find = partial(places, [NORMAL_LOAD], choice, None)
    with _refusals_of(path):
        table = _table(path, find)
        if len(table.lines) == 1 and not any(table.names):  # a row of loads
            lines = table.lines.repeat(len(table.names))
            table = Table(table.separator, lines, [""], table.cells.T)
        if len(table.names) > 1 and not choice:
            found = [BLOCK.fullmatch(label) for label in table.cells[:, 0]]
            numbers = [label and int(label[1]) for label in found]
            if numbers != list(range(1, len(found) + 1)):
                raise ValueError(
                    f"columns: {len(table.names)}; needed: {NORMAL_LOAD}, one a line, "
                    "alone or after the number of its block, 1, 2, 3, ..., or chosen with "
                    '--columns "w=NAME"'
                )
            table = table._replace(names=table.names[1:], cells=table.cells[:, 1:])
        return _numbers(path, _chosen(table, find), [NORMAL_LOAD])[:, 0].tolist()


def read_profile(path: AnyPath, choice: Mapping[str, str] | None = None) -> Numbers:
    """The shape of a pressure or load in any unit, a line for each position from the
    trailing edge on: a column, or a matrix without names. `choice` may have the name of
    the column as p."""
    find = partial(places, [PROFILE], choice, None)
    with _refusals_of(path):
        table = _table(path, find)
        if choice or len(table.names) == 1:
            table = _chosen(table, find)
        is_matrix = len(table.names) > 1
        if is_matrix and any(table.names):
            raise ValueError(f"columns: {len(table.names)}; {PROFILE_NEEDED}")
        numbers = _numbers(path, table, [PROFILE] * len(table.names))
        steps = np.diff(numbers[:, 0])
        has_positions = len(steps) > 1 and 0 < steps.max() < 1.0001 * steps.min()
        if len(numbers) == 1 or (is_matrix and has_positions):
            raise ValueError(f"lines: {len(numbers)}; {PROFILE_NEEDED}")
        return numbers


@contextmanager
def _refusals_of(source: object) -> Iterator[str]:
    """Puts the name of a table before what is wrong in it."""
    path = str(source) if isinstance(source, (str, PathLike)) else "data"
    try:
        yield path
    except (ValueError, csv.Error) as error:
        raise ValueError(f"{path}: {error}") from None


def _table(source: AnyPath | pd.DataFrame, find: Find) -> Table:
    """A table without its empty columns; no row has a cell beside the names."""
    text = _text(source)
    separator = _separator(text)
    names, body = _names(_rows(text, separator), find)
    if not body:
        raise ValueError("there are no numbers")
    for line, cells in body:
        if len(cells) > len(names) or (separator == " " and len(cells) < len(names)):
            raise ValueError(
                f"line {line}: cells: {len(cells)}, columns: {len(names)} (are there "
                "decimal commas, or names with blanks?)"
            )
    lines, filled = zip(*body, strict=True)
    columns = np.array([*zip_longest(names, *filled, fillvalue="")], dtype=object)
    columns = columns[(columns[:, 1:] != "").any(axis=1)]
    return Table(separator, np.array(lines), columns[:, 0].tolist(), columns[:, 1:].T)


def _text(source: AnyPath | pd.DataFrame) -> str:
    if not isinstance(source, (str, PathLike)):
        has_names = all(isinstance(name, str) for name in source.columns)
        return source.to_csv(sep=";", index=False, header=has_names)
    content = read_bytes(source)
    if b"\0" in content:
        raise ValueError(
            "it is not plain text: in the spreadsheet, save the table as CSV (UTF-8)"
        )
    try:
        text = content.decode("utf-8-sig")
    except UnicodeDecodeError:  # names in other letters are not known then
        text = content.decode("latin-1")
    return re.sub("\r\n?", "\n", text)


def _separator(text: str) -> str:
    """What separates columns, by the last line; if its commas may stand in numbers, by
    the last line of names."""
    lines = [line.strip() for line in text.split("\n") if re.search(r"\w", line)]
    last = lines[-1] if lines else ""
    fields = last.split()
    if ";" in last or "\t" in last:
        return ";" if ";" in last else "\t"
    are_numbers = all(map(NUMBER.fullmatch, fields))
    if len(fields) > 1 and (are_numbers or "," not in last):
        return " "
    heads = [line for line in lines if re.match(r"[^\w#%]*[^\W\d_]", line)]
    head = heads[-1].split(",") if heads else []
    if "," not in last or (are_numbers and len(head) == 1):
        return NO_SEPARATOR
    begins_with_unit = is_unit(next(filter(None, head), ""))  # as a line of units
    if begins_with_unit == any(map(is_unit, head)) and (head or not are_numbers):
        return ","
    raise ValueError(
        f"{last!r} may be one number with a decimal comma, or two numbers, and a name may "
        "have a comma: separate columns by semicolons, or write decimal points"
    )


def _rows(text: str, separator: str) -> list[Row]:
    """Rows that are not empty, without blanks around their cells, empty cells at the
    end, and the signs of comments that begin with a letter."""
    text = re.sub(r"(?m)^ +|[ ;,\t]+$|^[#%]+ *(?=[^\W\d]|$)", "", text)
    if separator == " ":
        text = re.sub(r" +(?![\[(])", "\t", text)
    delimiter = separator.replace(" ", "\t")
    lines = io.StringIO(text)
    reader = csv.reader(lines, delimiter=delimiter, skipinitialspace=True, strict=True)
    rows = [(reader.line_num, [cell.strip() for cell in cells]) for cells in reader]
    return [row for row in rows if any(row[1])]


def _names(rows: list[Row], find: Find) -> tuple[list[str], list[Row]]:
    """Names of the columns and the rows below: of the first line that names what is
    wanted, above any row of numbers; empty where no line has names."""
    units: list[str] = []
    refusal = None
    for i, (_, cells) in enumerate(rows[:MOST_ABOVE], 1):
        has_number = list(map(_is_number, filter(None, cells)))
        if all(has_number):
            break
        if UNITS_ABOVE.match(cells[0]):
            units = ["", *cells[1:]]
        if any(has_number):
            continue
        below = rows[i][1] if i < len(rows) else []
        has_units = any(map(is_unit, below)) and not any(map(_is_number, below))
        names = _with_units(cells, below if has_units else units)
        try:
            find(names)
        except ValueError as error:
            refusal = error
        else:
            return names, rows[i + has_units :]
    if refusal:
        raise refusal
    return [""] * len(rows[0][1] if rows else []), rows


def _with_units(names: Sequence[str], units: Sequence[str]) -> list[str]:
    inside = [unit.strip(BRACKETS) for unit in units]
    pairs = zip_longest(names, inside, fillvalue="")
    return [f"{name} [{unit}]" if unit else name for name, unit in pairs]


def _is_number(cell: str) -> bool:
    return bool(NUMBER.fullmatch(cell) or STAMP.fullmatch(cell))


def _chosen(table: Table, find: Find) -> Table:
    """The columns of a table that are wanted."""
    places = find(table.names)
    names = [table.names[i] for i in places]
    return table._replace(names=names, cells=table.cells[:, places])


def _numbers(
    path: object, table: Table, kinds: Sequence[str], length: float | None = None
) -> Numbers:
    """Numbers of columns, in the units of their kinds."""
    cells = [cell for cell in table.cells.flat if ":" not in cell]  # no time stamps
    with_commas = [cell for cell in cells if "," in cell]
    if with_commas and any("." in cell for cell in cells):
        raise ValueError("it has decimal commas and decimal points: write one")
    in_thousands = with_commas and all(map(THOUSANDS.fullmatch, with_commas))
    if in_thousands and table.separator not in ";\t":
        raise ValueError(
            f"{with_commas[0]!r} may have a decimal comma or be in thousands: write "
            "decimal points"
        )
    numbers = []
    for name, kind, fields in zip(table.names, kinds, table.cells.T, strict=True):
        stamps = [found.groups() for f in fields if (found := STAMP.fullmatch(f))]
        if kind == TIME and len(stamps) == len(fields):
            numbers.append(_seconds(stamps))
            continue
        rank, scale = meaning(name, kind, length)
        if scale is None:
            raise ValueError(f"the unit of {name!r} is not one of {kind}")
        if name and (scale != 1.0 or rank >= HALF):
            warnings.warn(f"{path}: {kind} is read from {name!r}", stacklevel=3)
        numbers.append(scale * np.array(list(map(_number, table.lines, fields))))
    return np.column_stack(numbers)


def _seconds(stamps: Sequence[tuple[str, ...]]) -> Numbers:
    """Seconds since the first of time stamps less than half a day apart."""
    dates, *clock = zip(*stamps, strict=True)
    hours, minutes, seconds = (
        np.char.replace(part, ",", ".").astype(float) for part in clock
    )
    times = np.unwrap(3600 * hours + 60 * minutes + seconds, period=DAY)
    if any(dates) and len(set(dates)) != len(set(times // DAY)):
        raise ValueError("half a day or more between two time stamps")
    return times - times[0]


def _number(line: int, field: str) -> float:
    """The number that a field holds."""
    value = field.replace(",", ".")
    if NUMBER.fullmatch(field) and math.isfinite(float(value)):
        return float(value)
    raise ValueError(
        f"line {line}: {field[:40]!r} is not a number "
        "(write it without a unit and separators of thousands)"
    )
