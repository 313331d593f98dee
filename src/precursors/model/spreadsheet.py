"""Tables of numbers as spreadsheets write them: what cannot be understood for certain
is refused."""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Iterable, Sequence
from itertools import takewhile
from os import PathLike
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

NUMBER = re.compile(r"[-+]?(\d+([.,]\d*)?|[.,]\d+)([eE][-+]?\d{1,3})?")
GROUPED = re.compile(r"[-+]?\d{1,3}([.,'\u2019\s]\d{3})+([.,]\d+)?")
# An error of a spreadsheet, such as #N/A or #DIV/0!, is no comment.
COMMENT = re.compile(r"#(?!N/A|NV|[A-Z/0]+[!?])")
# A line of names begins with one, and has no number between separators.
NAMES = re.compile(
    r"(?!nan|inf|n/?a\b)[\s;,\"\[(]*[^\W\d](?!.*(?<![\w\[(^])[-+]?[.,]?\d)",
    re.IGNORECASE,
)
# Commas between columns: beside a decimal point or a blank, or several in a line. The
# point of 1.018,00 is none.
SEPARATING = re.compile(r"(?<=\b0)\.|\.(?!\d{3},)|,\s|,[^,]*,")
UNIT = re.compile(
    r"\[\s*([^\]]*?)\s*\]|(?:[(/\s]|^)(s|N)\)?$"
    r"|(?<![a-zA-Z])(kN|MN|mN|daN|kgf?|lbf?|ms|us|µs|μs|ns|min|h|mm|cm|µm|μm)(?![a-zA-Z])"
)
# The columns that are read here, and words that name them.
TIME = "t [s]"
LOAD = "F_X [N]"
LENGTH = "L_p/L [-]"
NORMAL_LOAD = "normal load of each block [N]"
_LOADS = "f|load|force|fuerza|forza|last|[a-z]*kraft"
WORDS = {
    TIME: "t|time|zeit|temps|tiempo|tempo",
    LOAD: f"f_?x|{_LOADS}",
    LENGTH: "l|l_?p|length|länge|longueur",
    NORMAL_LOAD: _LOADS,
}
# The fields of each line, by its number.
Rows = dict[int, list[str]]


def read_columns(
    path: str | PathLike[str], needed: Sequence[str]
) -> NDArray[np.float64]:
    """Read columns of numbers, keys of `WORDS`: by their units, by their names, or in
    this order.

    A file may have lines of names; commas, semicolons, tabs or blanks between columns;
    and decimal commas. Empty columns and lines, and lines that begin with #, are passed
    over.

    Returns
    -------
    ndarray, shape (number of lines, number of columns)
        In the order of `needed`.

    Raises
    ------
    OSError
        If the file cannot be read.
    ValueError
        In one line with file, line, and what is needed.
    """
    return _columns(path, *_fields(path), needed)


def read_weights(path: str | PathLike[str]) -> list[float]:
    """Normal loads [N], a number for each block, alone or after the number or name of
    the block: 1 or b1, 2 or b2."""
    names, rows = _fields(path)
    if len(rows) == 1 and len(names) > 2:  # a table of one line
        rows = dict(enumerate(([field] for field in rows.popitem()[1]), 1))
        names = [""]
    if len(names) > 1:
        labels = [re.search(r"(\d+)([.,]0*)?$", row.pop(0)) for row in rows.values()]
        numbers = [int(label[1]) for label in labels if label]
        if numbers != list(range(1, len(rows) + 1)):
            raise ValueError(
                f"{path}: columns: {len(names)}; needed: {NORMAL_LOAD}, one a line, "
                "alone or after the number of its block, 1, 2, 3, ..."
            )
        names = names[1:]
    loads = _columns(path, names, rows, [NORMAL_LOAD])
    return [float(load) for load in loads[:, 0]]


def _fields(path: str | PathLike[str]) -> tuple[list[str], Rows]:
    """Names and fields of the columns of a file that are not empty."""
    if not Path(path).is_file():
        raise ValueError(
            f"{path} is not a file" if Path(path).exists() else f"{path}: no such file"
        )
    text = Path(path).read_bytes().decode("utf-8-sig", errors="replace")
    if "\0" in text:
        raise ValueError(
            f"{path} is not plain text: in the spreadsheet, save the table as CSV (UTF-8)"
        )
    lines = {n: line.strip(" \u00a0") for n, line in enumerate(text.splitlines(), 1)}
    for n, line in list(lines.items()):
        says_separator = re.fullmatch('"?sep=."?', line)
        if says_separator or COMMENT.match(line) or not line.strip('\t;,"'):
            del lines[n]
    above = list(takewhile(NAMES.match, lines.values()))
    rest = dict(list(lines.items())[len(above) :])
    if not rest:
        raise ValueError(f"{path} has no numbers")
    separator = _separator(path, above, list(rest.values()))
    rows = {n: _cut(line, separator) for n, line in rest.items()}
    width = max(map(len, rows.values()))
    rows = {n: row + [""] * (width - len(row)) for n, row in rows.items()}
    used = [j for j in range(width) if any(row[j] for row in rows.values())]
    names = [""] * width
    for line in above:
        parts = _cut(line, separator)
        parts = parts * width if len(parts) == 1 else parts  # a title
        for j, part in enumerate(parts[:width]):
            names[j] = f"{names[j]} {part}".strip()
    return [names[j] for j in used], {
        n: [row[j] for j in used] for n, row in rows.items()
    }


def _separator(
    path: str | PathLike[str], above: Sequence[str], rows: Sequence[str]
) -> str:
    """What stands between two columns: a blank is any space, and a semicolon stands for
    a single column."""
    for separator in ";\t":
        if any(separator in line for line in (*above, *rows)):
            return separator
    plain = [re.sub(r'"[^"]*"', '""', line) for line in rows]
    if not any("," in line for line in plain):
        return " " if any(re.search(r"\s", line) for line in plain) else ";"
    names = above[0].split(",") if above else []
    if len(names) == 1 and not any(map(SEPARATING.search, plain)):
        return ";"  # one column, with decimal commas
    is_named = names and not any(UNIT.fullmatch(name.strip()) for name in names)
    if is_named or NAMES.match(rows[0][:1]) or any(map(SEPARATING.search, plain)):
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


def _columns(
    path: str | PathLike[str], names: Sequence[str], rows: Rows, needed: Sequence[str]
) -> NDArray[np.float64]:
    """Numbers of the columns that are needed."""
    kinds = [_kind(name, needed) for name in names]
    if len(kinds) == len(needed):
        missing = iter([kind for kind in needed if kind not in kinds])
        kinds = [kind or next(missing) for kind in kinds]
    if any(kinds.count(kind) != 1 for kind in needed):
        raise ValueError(
            f"{path}, line {min(rows)}: columns: {len(names)}; needed: {', '.join(needed)}"
        )
    for name, kind in zip(names, kinds, strict=True):
        if kind and _unit(name) not in ("", _unit(kind)):
            raise ValueError(
                f"{path}: the column {name!r} is in {_unit(name)}; needed: {kind}"
            )
    columns = [kinds.index(kind) for kind in needed]
    fields = [(n, row[j]) for n, row in rows.items() for j in columns]
    numbers = [_number(path, n, field) for n, field in fields]
    if {",", "."} <= set("".join(field for _, field in fields)):
        raise ValueError(f"{path} has decimal commas and decimal points: write one")
    return np.reshape(numbers, (-1, len(needed)))


def _kind(name: str, needed: Iterable[str]) -> str | None:
    """Which of the needed columns has this unit, or else a word of this name."""
    by_unit = [kind for kind in needed if _unit(name) and _unit(name) == _unit(kind)]
    words = r"(?<![^\W\d_])({})(?![^\W\d_])"
    by_word = [
        kind
        for kind in needed
        if re.search(words.format(WORDS[kind]), UNIT.sub("", name), re.IGNORECASE)
    ]
    return next(iter(by_unit + by_word), None)


def _unit(name: str) -> str:
    """The unit in the name of a column; nothing for 1 or none."""
    found = UNIT.search(name)
    return found[found.lastindex or 0].strip("-1") if found else ""


def _number(path: str | PathLike[str], line: int, field: str) -> float:
    """The number that a field holds."""
    value = field.replace(",", ".")
    if NUMBER.fullmatch(field) and math.isfinite(float(value)):
        return float(value)
    is_grouped = GROUPED.fullmatch(field)
    why = "has a separator of thousands" if is_grouped else "is not a number"
    raise ValueError(f"{path}, line {line}: {field!r} {why}")
