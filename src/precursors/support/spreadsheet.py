"""Tables of numbers as spreadsheets and instruments write them: what cannot be
understood for certain is refused."""

from __future__ import annotations

import csv
import math
import re
import warnings
from collections.abc import Sequence
from itertools import islice, takewhile, zip_longest
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from precursors.support.files import AnyPath
from precursors.support.units import (
    BARE,
    LENGTH,
    LOAD,
    NORMAL_LOAD,
    OTHERS,
    TIME,
    candidates,
    factors,
    has_word,
    is_named,
    units,
)

if TYPE_CHECKING:
    import pandas as pd

__all__ = ["LENGTH", "LOAD", "TIME", "read_columns", "read_profile", "read_weights"]

NUMBER = re.compile(r"[-+]?(\d+([.,]\d*)?|[.,]\d+)([eE][-+]?\d{1,3})?")
# A date or none, hours, minutes, seconds.
STAMP = re.compile(
    r"(?:(\S+)[ T])?(\d{1,2}):(\d\d):(\d\d(?:[.,]\d*)?)(?:Z|[-+][\d:]+)?"
)
DAY = 86_400.0  # [s]
# Empty lines, sep=; and comments; an error of a spreadsheet, such as #N/A or #DIV/0!, is
# no comment.
PASSED_OVER = re.compile(r'(?:[\t;,"]*|"?sep=."?)$|%|#(?!N/A|NV|[A-Z/0]+[!?])')
# A line of names begins with one, and has no number between separators; where nothing
# but blanks separates, no number after a blank.
NAMES = re.compile(
    r"(?!nan|inf|n/?a\b)[\s;,\"\[(]*[^\W\d](?!.*[;,\t]\s*\"?[-+]?[.,]?\d)"
    r"(?![^;,\t]*(?<![\w\[(^])[-+]?[.,]?\d[^;,\t]*$)",
    re.IGNORECASE,
)
# Above a table: LabVIEW's last line; other lines, and one of units, which begin so.
END_OF_HEADER = "***End_of_Header***"
REMARK = re.compile(r"\W*[^\W\d]")
OF_UNITS = re.compile(r"[^;,\t:]*(unit|einheit)", re.IGNORECASE)
# Commas between columns: beside a decimal point or a blank, or several in a line. The
# point of 1.018,00 is none.
SEPARATING = re.compile(r"(?<=\b0)\.|\.(?!\d{3},)|,[^\S\n]|,[^,\n]*,")
# Only accented Latin letters: in other encodings, a name or a unit is not what it seems.
NOT_LATIN = re.compile(r"[^\x00-\x7f\xa0µÀ-ÖØ-öø-ÿ]|[À-ÖØ-öø-ÿ]{3}")


class Table(NamedTuple):
    """A table of text."""

    path: str  # or what else it is called
    lines: Sequence[int]  # number of each row's line
    names: Sequence[str]
    columns: Sequence[Sequence[str]]  # fields from top to bottom


def read_columns(
    source: AnyPath | pd.DataFrame,
    needed: Sequence[str],
    sample_rate: float | None = None,
) -> NDArray[np.float64]:
    """Read columns of numbers: by their units and words for them, or in this order.

    A file may have lines of names, and other lines above them; commas, semicolons, tabs
    or blanks between columns; decimal commas; time stamps. Empty columns and lines, and
    lines that begin with # or %, are passed over. Values are converted to the unit needed; a
    warning tells this, and how many rows lack a value.

    Parameters
    ----------
    source : path or DataFrame
        The table.
    needed : sequence of str
        Which columns, keys of `WORDS`.
    sample_rate : float, optional
        Lines per second [Hz], for a table without times.

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
    wanted = [kind for kind in needed if kind != TIME or sample_rate is None]
    table = _chosen(_table(source, wanted), wanted)
    rows = list(zip(table.lines, *table.columns, strict=True))
    kept = [row for row in rows if all(row)]
    if not kept:
        raise ValueError(f"{table.path} has no numbers")
    lines, *columns = zip(*kept, strict=True)
    numbers = _numbers(table._replace(lines=lines, columns=columns), wanted)
    if missing := len(rows) - len(kept):
        warnings.warn(f"{table.path}: rows without a value: {missing}", stacklevel=2)
    if sample_rate is None:
        return numbers
    return np.column_stack([(np.array(lines) - rows[0][0]) / sample_rate, numbers])


def read_weights(path: AnyPath) -> list[float]:
    """Normal loads [N], a number for each block, alone or after the number or name of
    the block: 1 or b1, 2 or b2."""
    table = _table(path, [NORMAL_LOAD])
    name, lines, names, columns = table
    if len(lines) == 1 and len(columns) > 2:  # a table of one line, as of the explorer
        fields = [field for (field,) in columns]
        table = Table(name, [*lines] * len(fields), [" ".join(names)], [fields])
    elif len(columns) > 1:
        labels = (re.search(r"(\d+)([.,]0*)?$", label) for label in columns[0])
        numbers = [label and int(label[1]) for label in labels]
        if numbers != list(range(1, len(lines) + 1)):
            raise ValueError(
                f"{path}: columns: {len(columns)}; needed: {NORMAL_LOAD}, one a line, "
                "alone or after the number of its block, 1, 2, 3, ..."
            )
        table = Table(name, lines, names[1:], columns[1:])
    loads = _numbers(_chosen(table, [NORMAL_LOAD]), [NORMAL_LOAD])
    return [float(load) for [load] in loads]


def read_profile(path: AnyPath) -> NDArray[np.float64]:
    """The shape of a pressure or load in any unit, a line for each position from the
    trailing edge on: a column, or a matrix without names."""
    table = _table(path, [])
    numbers = _numbers(table, [None] * len(table.columns))
    steps = np.diff(numbers[:, 0])
    has_positions = len(steps) > 1 and 0 < steps.max() < 1.0001 * steps.min()
    if len(table.columns) > 1 and (any(table.names) or has_positions):
        raise ValueError(
            f"{path}: columns: {len(table.columns)}; needed: one column, or a matrix "
            "without names and positions"
        )
    return numbers


def _text(source: AnyPath) -> str:
    content = Path(source).read_bytes()
    if b"\0" in content:
        raise ValueError(
            f"{source} is not plain text: in the spreadsheet, save the table as CSV (UTF-8)"
        )
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError:
        text = content.decode("latin-1")
    if NOT_LATIN.search(text):
        raise ValueError(f"{source} is not UTF-8: save the table as CSV (UTF-8)")
    return text


def _table(source: AnyPath | pd.DataFrame, needed: Sequence[str]) -> Table:
    """A table without its empty rows and columns."""
    if isinstance(source, (str, PathLike)):
        path = str(source)
        text = _text(source)
    else:
        path = "data"
        has_names = all(isinstance(name, str) for name in source.columns)
        text = source.to_csv(sep=";", index=False, header=has_names)
    lines = {
        n: line
        for n, whole in enumerate(text.splitlines(), 1)
        if not PASSED_OVER.match(line := whole.strip(" \u00a0"))
    }
    written = list(lines.values())
    start = _start(path, written, needed)
    above = list(takewhile(NAMES.match, written[start:]))
    below = written[start + len(above) :]
    if not below:
        raise ValueError(f"{path} has no numbers")
    separator = _separator(path, above, below)
    try:
        rows = [_cut(line, separator) for line in below]
        heads = [_cut(line, separator) for line in above]
    except csv.Error as error:
        raise ValueError(f"{path} is not a table: {error}") from None
    columns = list(zip_longest(*rows, fillvalue=""))
    if not heads:  # two comments may be names and units
        comments = re.findall(r"(?m)^[#%][^\S\n]*(\S.*)", text)
        heads = [_cut(line, separator) for line in comments]
        heads = [head for head in heads if len(head) == len(columns)]
        heads = heads[-min(len(columns), 2) :]
    parts = zip_longest([""] * len(columns), *_heads(heads, len(columns)), fillvalue="")
    names = (" ".join(filter(None, part)) for part in parts)
    named = [
        (name, column)
        for name, column in zip(names, columns, strict=False)
        if any(column)
    ]
    return Table(path, list(lines)[start + len(above) :], *zip(*named, strict=True))


def _start(path: str, lines: Sequence[str], needed: Sequence[str]) -> int:
    """Where a table begins: below LabVIEW's headers, of the file and its first segment,
    or at the lines of names around the first that names what is needed, if only remarks
    stand above it."""
    ends = [i for i, line in enumerate(lines, 1) if line.startswith(END_OF_HEADER)]
    named = (
        i
        for i, line in enumerate(takewhile(REMARK.match, lines))
        if NAMES.match(line)
        and all(candidates(re.split(r"[;,\t]", line), kind) for kind in needed)
    )
    start = ends[:2][-1] if ends else next(named, 0)
    while start and NAMES.match(lines[start - 1]):
        start -= 1
    for remark in filter(OF_UNITS.match, lines[:start]):
        _, *given = re.split(r"\s*[;,\t:]\s*", remark)
        for unit in filter(None, given):
            if needed and all(factors(f"[{unit}]", k) != {1.0} for k in needed):
                raise ValueError(
                    f"{path}: {unit!r} is not a unit of {' or '.join(needed)}"
                )
    return start


def _heads(heads: Sequence[list[str]], width: int) -> list[list[str]]:
    """Lines of names, with brackets around a line of units; of a title above all
    columns, the units."""
    found: list[list[str]] = []
    for head in heads:
        are_units = any(map(BARE.fullmatch, head)) or any(map(is_named, found))
        if are_units and not is_named(head):
            head = [cell and f"[{cell.strip('[({})] ')}]" for cell in head]
        if len(head) == 1 < width:
            head = ["".join(f"[{unit}]" for unit in units(head[0]))] * width
        found.append(head)
    return found


def _separator(path: str, above: Sequence[str], rows: Sequence[str]) -> str:
    """Separator of two columns: a blank is any space, and a semicolon stands for a
    single column."""
    for separator in ";\t":
        if separator in "".join((*above, *rows)):
            return separator
    plain = re.sub(r'"[^"\n]*"', '""', "\n".join(rows))
    if "," not in plain or re.search(r"\d,\d+[^\S\n]+[-+]?\d", plain):
        return " " if re.search(r"[^\S\n]", plain) else ";"
    names = max((line.split(",") for line in above), key=len, default=[])
    is_separating = SEPARATING.search(plain)
    if len(names) == 1 and not is_separating:
        return ";"  # one column, with decimal commas
    has_unit = any(BARE.fullmatch(name.strip()) for name in names)
    if (names and not has_unit) or is_separating or NAMES.match(rows[0][:1]):
        return ","
    raise ValueError(
        f"{path}: {rows[-1]!r} may be one number with a decimal comma, or two numbers: "
        "separate columns by semicolons, or write decimal points"
    )


def _cut(line: str, separator: str) -> list[str]:
    """The fields of a line, without blanks and quotes around them."""
    if separator == " ":
        return [field.strip('"') for field in re.split(r"\s+(?![\[(])", line)]
    [fields] = csv.reader([line], delimiter=separator, skipinitialspace=True)
    return [field.strip() for field in fields]


def _chosen(table: Table, needed: Sequence[str]) -> Table:
    """The columns of a table that are needed."""
    path, lines, names, columns = table
    places = [candidates(names, kind) for kind in needed]
    if len(names) == len(needed):
        free = sorted(set(range(len(needed))).difference(*places))
        others = (i for i in free if units(names[i]) or not has_word(names[i], OTHERS))
        places = [found or list(islice(others, 1)) for found in places]
    chosen = [i for found in places for i in found]
    if not len(chosen) == len(set(chosen)) == len(needed) == sum(map(bool, places)):
        told = ", ".join(filter(None, names))
        raise ValueError(
            f"{path}, line {lines[0]}: columns: {len(names)} ({told}); "
            f"needed: {', '.join(needed)}"
        )
    return Table(path, lines, [names[i] for i in chosen], [columns[i] for i in chosen])


def _numbers(table: Table, needed: Sequence[str | None]) -> NDArray[np.float64]:
    """Numbers of columns in the units that are needed."""
    numbers = []
    digits = ""
    for name, fields, kind in zip(table.names, table.columns, needed, strict=True):
        stamps = [found.groups() for f in fields if (found := STAMP.fullmatch(f))]
        if kind == TIME and len(stamps) == len(fields):
            numbers.append(_seconds(table.path, stamps))
            continue
        factor = factors(name, kind) if kind and units(name) else {1.0}
        if len(factor) != 1:
            raise ValueError(
                f"{table.path}: the column {name!r} is in {', '.join(units(name))}; needed: {kind}"
            )
        if factor != {1.0}:
            warnings.warn(
                f"{table.path}: {name!r} is converted to {kind}", stacklevel=3
            )
        at = zip(table.lines, fields, strict=True)
        numbers.append(factor.pop() * np.array([_number(table.path, *x) for x in at]))
        digits += "".join(fields)
    if {",", "."} <= set(digits):
        raise ValueError(
            f"{table.path} has decimal commas and decimal points: write one"
        )
    return np.column_stack(numbers)


def _seconds(path: str, stamps: Sequence[tuple[str, ...]]) -> NDArray[np.float64]:
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
