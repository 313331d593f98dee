"""Tables of numbers as spreadsheets write them: what cannot be understood for certain
is refused."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from os import PathLike
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

NUMBER = re.compile(r"[-+]?(\d+([.,]\d*)?|[.,]\d+)([eE][-+]?\d{1,3})?")
# A name of a column: a table may begin with a line of such names.
NAME = re.compile(r"(?!nan|inf|n/?a\b)\"?[^\W\d]", re.IGNORECASE)
# Units that a header may name and that are not SI base units of the columns read here.
OTHER_UNITS = re.compile(
    r"(?<![a-zA-Z])(kN|MN|mN|daN|kgf?|lbf?|ms|us|µs|μs|ns|min|h|mm|cm|µm|μm)(?![a-zA-Z])"
)


def read_columns(
    path: str | PathLike[str], names: Sequence[str], exactly: bool = False
) -> NDArray[np.float64]:
    """Read a table of numbers: a header line or none; commas, semicolons, tabs or
    spaces; decimal commas.

    Parameters
    ----------
    path : path
        A text file. Empty lines and lines that begin with # are passed over.
    names : sequence of str
        What the columns must be, with units, as a message gives them.
    exactly : bool
        Whether there must be as many columns as names.

    Returns
    -------
    ndarray, shape (number of lines, number of columns)
        Every line has as many numbers.

    Raises
    ------
    OSError
        If the file cannot be read.
    ValueError
        In one line with file, line, and what is needed.
    """
    if not Path(path).is_file():
        raise ValueError(
            f"{path} is not a file" if Path(path).exists() else f"{path}: no such file"
        )
    text = Path(path).read_bytes().decode("utf-8-sig", errors="replace")
    if "\0" in text:
        raise ValueError(f"{path} is not plain text: save the table as CSV (UTF-8)")
    lines = [(n, line.strip()) for n, line in enumerate(text.splitlines(), 1)]
    lines = [(n, line) for n, line in lines if line and not line.startswith("#")]
    needed = f"needed are columns of numbers: {', '.join(names)}"
    if not lines:
        raise ValueError(f"{path} is empty; {needed}")
    separator = _separator(path, [line for _, line in lines])
    rows = [
        (n, [field.strip().strip('"') for field in re.split(separator, line)])
        for n, line in lines
    ]
    if NAME.match(rows[0][1][0]) and not any(
        NUMBER.fullmatch(field) for field in rows[0][1]
    ):
        (n, header), *rows = rows
        for field in header:
            if unit := OTHER_UNITS.search(field):
                raise ValueError(
                    f"{path}, line {n}: the column {field!r} is in {unit[0]}; {needed}"
                )
    if not rows:
        raise ValueError(f"{path} has a header and no numbers; {needed}")
    first = rows[0][0]
    width = len(rows[0][1])
    if exactly and width != len(names):
        raise ValueError(f"{path}, line {first}: columns: {width}; {needed}")
    for n, row in rows:
        for field in row:
            if not NUMBER.fullmatch(field) or not math.isfinite(
                float(field.replace(",", "."))
            ):
                raise ValueError(
                    f"{path}, line {n}: {field!r} is not a number; {needed}"
                )
        if len(row) != width:
            raise ValueError(
                f"{path}, line {n}: columns: {len(row)}, in line {first}: {width}; {needed}"
            )
    return np.array(
        [[float(field.replace(",", ".")) for field in row] for _, row in rows]
    )


def _separator(path: str | PathLike[str], lines: Sequence[str]) -> str:
    """What stands between two numbers, as a regular expression."""
    for separator in (";", "\t"):
        if any(separator in line for line in lines):
            return separator
    if not any("," in line for line in lines):
        return r"\s+"
    # A comma is no decimal comma between names, beside decimal points or spaces, or if
    # there are several.
    between_names = NAME.match(lines[0]) and "," in lines[0]
    if not between_names and not any(
        re.search(r"\.|,\s|,[^,]*,", line) for line in lines
    ):
        raise ValueError(
            f"{path}: {lines[-1]!r} may be one number with a decimal comma, or two numbers: "
            "separate columns by semicolons, or write decimal points"
        )
    return r"\s*,\s*"
