"""Tables of numbers as spreadsheets write them: what cannot be understood for certain
is refused."""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Sequence
from itertools import takewhile, zip_longest
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from precursors.support.files import AnyPath

# The name of each column, and its fields from top to bottom.
Columns = list[tuple[str, tuple[str, ...]]]

NUMBER = re.compile(r"[-+]?(\d+([.,]\d*)?|[.,]\d+)([eE][-+]?\d{1,3})?")
GROUPED = re.compile(r"[-+]?\d{1,3}([.,'\u2019\s]\d{3})+([.,]\d+)?")
# Empty lines, sep=; and comments; an error of a spreadsheet, such as #N/A or #DIV/0!, is
# no comment.
PASSED_OVER = re.compile(r'(?:[\t;,"]*|"?sep=."?)$|#(?!N/A|NV|[A-Z/0]+[!?])')
# A line of names begins with one, and has no number between separators.
NAMES = re.compile(
    r"(?!nan|inf|n/?a\b)[\s;,\"\[(]*[^\W\d](?!.*(?<![\w\[(^])[-+]?[.,]?\d)",
    re.IGNORECASE,
)
# Commas between columns: beside a decimal point or a blank, or several in a line. The
# point of 1.018,00 is none.
SEPARATING = re.compile(r"(?<=\b0)\.|\.(?!\d{3},)|,[^\S\n]|,[^,\n]*,")
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


def read_columns(path: AnyPath, needed: Sequence[str]) -> NDArray[np.float64]:
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
    return _numbers(path, *_fields(path), needed)


def read_weights(path: AnyPath) -> list[float]:
    """Normal loads [N], a number for each block, alone or after the number or name of
    the block: 1 or b1, 2 or b2."""
    lines, columns = _fields(path)
    if len(lines) == 1 and len(columns) > 2:  # a table of one line, as of the explorer
        columns = [("", tuple(field for _, (field,) in columns))]
        lines *= len(columns[0][1])
    if len(columns) > 1:
        labels = (re.search(r"(\d+)([.,]0*)?$", label) for label in columns[0][1])
        numbers = [label and int(label[1]) for label in labels]
        if numbers != list(range(1, len(lines) + 1)):
            raise ValueError(
                f"{path}: columns: {len(columns)}; needed: {NORMAL_LOAD}, one a line, "
                "alone or after the number of its block, 1, 2, 3, ..."
            )
        del columns[0]
    return list(map(float, _numbers(path, lines, columns, [NORMAL_LOAD])[:, 0]))


def _fields(path: AnyPath) -> tuple[list[int], Columns]:
    """Numbers of the lines of a file, and its columns, without empty ones."""
    text = Path(path).read_bytes().decode("utf-8-sig", errors="replace")
    if "\0" in text:
        raise ValueError(
            f"{path} is not plain text: in the spreadsheet, save the table as CSV (UTF-8)"
        )
    lines = {
        n: line
        for n, whole in enumerate(text.splitlines(), 1)
        if not PASSED_OVER.match(line := whole.strip(" \u00a0"))
    }
    above = list(takewhile(NAMES.match, lines.values()))
    below = list(lines.values())[len(above) :]
    if not below:
        raise ValueError(f"{path} has no numbers")
    separator = _separator(path, above, below)
    rows = [_cut(line, separator) for line in below]
    columns = list(zip_longest(*rows, fillvalue=""))
    heads = [_cut(line, separator) for line in above]
    # A title is above all columns.
    heads = [head * len(columns) if len(head) == 1 else head for head in heads]
    parts = zip_longest([""] * len(columns), *heads, fillvalue="")
    names = (" ".join(filter(None, part)) for part in parts)
    named = zip(names, columns, strict=False)
    numbers = list(lines)[len(above) :]
    return numbers, [(name, column) for name, column in named if any(column)]


def _separator(path: AnyPath, above: Sequence[str], rows: Sequence[str]) -> str:
    """Separator of two columns: a blank is any space, and a semicolon stands for a
    single column."""
    for separator in ";\t":
        if separator in "".join((*above, *rows)):
            return separator
    plain = re.sub(r'"[^"\n]*"', '""', "\n".join(rows))
    if "," not in plain:
        return " " if re.search(r"[^\S\n]", plain) else ";"
    names = above[0].split(",") if above else []
    is_separating = SEPARATING.search(plain)
    if len(names) == 1 and not is_separating:
        return ";"  # one column, with decimal commas
    is_named = names and not any(UNIT.fullmatch(name.strip()) for name in names)
    if is_named or is_separating or NAMES.match(rows[0][:1]):
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


def _numbers(
    path: AnyPath, lines: Sequence[int], columns: Columns, needed: Sequence[str]
) -> NDArray[np.float64]:
    """Numbers of the columns that are needed."""
    kinds = [_kind(name, needed) for name, _ in columns]
    if len(kinds) == len(needed):
        missing = iter([kind for kind in needed if kind not in kinds])
        kinds = [kind or next(missing) for kind in kinds]
    if any(kinds.count(kind) != 1 for kind in needed):
        raise ValueError(
            f"{path}, line {lines[0]}: columns: {len(kinds)}; needed: {', '.join(needed)}"
        )
    for kind, (name, _) in zip(kinds, columns, strict=True):
        if kind and _unit(name) not in ("", _unit(kind)):
            raise ValueError(
                f"{path}: the column {name!r} is in {_unit(name)}; needed: {kind}"
            )
    fields = [columns[kinds.index(kind)][1] for kind in needed]
    numbers = [
        [_number(path, line, field) for field in row]
        for line, *row in zip(lines, *fields, strict=True)
    ]
    if {",", "."} <= set("".join(map("".join, fields))):
        raise ValueError(f"{path} has decimal commas and decimal points: write one")
    return np.array(numbers)


def _kind(name: str, needed: Sequence[str]) -> str | None:
    """Which of the needed columns has this unit, or else a word of this name."""
    for kind in needed:
        if _unit(name) and _unit(name) == _unit(kind):
            return kind
    for kind in needed:
        word = rf"(?<![^\W\d_])({WORDS[kind]})(?![^\W\d_])"
        if re.search(word, UNIT.sub("", name), re.IGNORECASE):
            return kind
    return None


def _unit(name: str) -> str:
    """The unit in the name of a column; nothing for 1 or none."""
    found = UNIT.search(name)
    return found[found.lastindex or 0].strip("-1") if found else ""


def _number(path: AnyPath, line: int, field: str) -> float:
    """The number that a field holds."""
    value = field.replace(",", ".")
    if NUMBER.fullmatch(field) and math.isfinite(float(value)):
        return float(value)
    is_grouped = GROUPED.fullmatch(field)
    why = "has a separator of thousands" if is_grouped else "is not a number"
    raise ValueError(f"{path}, line {line}: {field!r} {why}")
