"""Read measured tables, whose columns are identified by name and unit or by choice."""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from os import PathLike
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from precursors.support.files import AnyPath, read_bytes

if TYPE_CHECKING:
    import pandas as pd

Numbers = NDArray[np.float64]
Choice = Mapping[str, str]  # from the symbol of a quantity to a column
BY_NAME: Choice = {}


@dataclass(frozen=True, eq=False)
class Quantity:
    """A quantity that a column may hold.

    `symbol` and `unit` are those of this library. A column has the quantity if its name
    is one of `names`, or one of `words` in capital or small letters. `units` has the
    size of each unit that is read, in terms of `unit`.
    """

    symbol: str
    unit: str
    names: tuple[str, ...]
    words: tuple[str, ...]
    units: Mapping[str, float]

    def __str__(self) -> str:
        return f"{self.symbol} [{self.unit}]"

    def is_named(self, name: str) -> bool:
        """Whether a column name without its unit names this quantity."""
        return name in self.names or name.casefold() in self.words


SECONDS = {"s": 1.0, "ms": 1e-3, "us": 1e-6, "min": 60.0, "h": 3600.0}
NEWTONS = {"N": 1.0, "kN": 1e3, "MN": 1e6, "mN": 1e-3, "lbf": 4.4482216152605}
METRES = {"m": 1.0, "cm": 1e-2, "mm": 1e-3, "um": 1e-6, "in": 0.0254}
SHARES = {"-": 1.0, "1": 1.0, "%": 1e-2}
# Only the shape of a pressure matters, so all units are equal.
PRESSURES = dict.fromkeys(["Pa", "kPa", "MPa", "bar", "psi", "N/mm2", *SHARES], 1.0)

TIME = Quantity("t", "s", ("t",), ("time",), SECONDS)
LOAD = Quantity("F_X", "N", ("F_X",), ("force", "load"), NEWTONS)
LENGTH = Quantity("L_p/L", "-", ("L_p/L", "L_p"), ("front length",), METRES | SHARES)
WEIGHT = Quantity("w", "N", ("w",), ("force", "load"), NEWTONS)
POSITION = Quantity("x", "m", ("x",), ("position",), METRES)
PRESSURE = Quantity("p", "MPa", ("p",), ("pressure",), PRESSURES)

COMMENT = re.compile(r"\s*[#%]")
# A spreadsheet marks a failed formula by #N/A or the like, which is not a comment.
FAILED = re.compile(r"\s*#[^\W\d_a-z][^\s;,a-z]*\s*([;,\t]|$)")
NUMBER = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d{1,3})?", re.ASCII)
BEGINS = re.compile(r"[-+.,]?\d")  # a number, possibly with more text in its cell
NAME_AND_UNIT = re.compile(r"(.*?)\s*[\[(]\s*([^\[\]()]*?)\s*[\])]")
ROUNDING = 1e-12  # a computed share may exceed 1 by this much


class Match(NamedTuple):
    """The column of a quantity: the text that chooses it, and its place and unit, or
    the reason for doubt."""

    suggestion: str
    place: int = 0
    unit: str = ""
    doubt: str = ""


class Table(NamedTuple):
    """A table of text.

    `lines` are the line numbers of its rows in the file. For a DataFrame they count
    from 1, and `separator` is empty.
    """

    names: Sequence[str]
    lines: Sequence[int]
    rows: Sequence[Sequence[str]]
    separator: str

    def columns(
        self, needed: Sequence[Quantity], choice: Choice, length: float = math.nan
    ) -> Numbers:
        """Return the numbers of some quantities in their units, shape (rows,
        quantities).

        `length` [m] is that of the slider; it converts front lengths in metres to
        shares.

        Raises
        ------
        ValueError
            If a column is ambiguous or missing, or a row is incomplete.
        """
        if not self.rows:
            raise ValueError("there are no numbers")
        # A single column needs no name.
        names = self.names or [str(needed[0]) if len(needed) == 1 else ""]
        matches = [(q, _match(q, names, choice.get(q.symbol, ""))) for q in needed]
        doubts = [match.doubt for _, match in matches if match.doubt]
        if doubts:
            self._check_that_numbers_are_below()
        for line, row in zip(self.lines, self.rows, strict=True):
            if len(row) != len(names):
                raise ValueError(
                    f"line {line}: cells: {len(row)}, columns: {len(names)} (write decimal "
                    "points, or semicolons between columns, and 0 for no load)"
                )
        if doubts:
            chosen = ",".join(f"{q.symbol}={match.suggestion}" for q, match in matches)
            how = "choose with --columns" if self.separator else "rename them, as in"
            called = ", ".join(map(repr, names))
            raise ValueError(
                f'{"; ".join(doubts)}; the columns are {called}: {how} "{chosen}"'
            )
        cells = "".join(row[match.place] for row in self.rows for _, match in matches)
        if self.separator in (";", "\t") and "," in cells and "." in cells:
            raise ValueError("it has decimal commas and decimal points: write one")
        return np.column_stack([self._numbers(*pair, length) for pair in matches])

    def _numbers(self, quantity: Quantity, match: Match, length: float) -> Numbers:
        is_share = quantity is LENGTH
        scale = quantity.units[match.unit]
        if is_share and match.unit in METRES:
            scale /= length
        values: list[float] = []
        for line, row in zip(self.lines, self.rows, strict=True):
            cell = row[match.place]
            text = cell if self.separator in ("", ",") else cell.replace(",", ".")
            value = scale * float(text) if NUMBER.fullmatch(text) else math.nan
            fault = ""
            if not math.isfinite(value):
                fault = f"{cell[:40]!r} is not a number: write one, or 0 for no load"
            elif quantity in (TIME, POSITION) and values and value <= values[-1]:
                fault = f"{quantity} must rise, but {value:g} follows {values[-1]:g}"
            elif is_share and not 0 <= value <= 1 + ROUNDING:
                fault = f"L_p/L must be between 0 and 1, but is {value:g}"
            if fault:
                raise ValueError(
                    f"{'line' if self.separator else 'row'} {line}: {fault}"
                )
            values.append(min(value, 1.0) if is_share else value)
        return np.array(values)

    def _check_that_numbers_are_below(self) -> None:
        begins = [bool(row and BEGINS.match(row[0])) for row in self.rows]
        if self.separator and True in begins[1:] and not begins[0]:
            line = self.lines[begins.index(True, 1) - 1]
            raise ValueError(
                f"{self.names[0]!r} is not the name of a column: if line {line} has the names, "
                f"--header-line {line}"
            )


def read_table(source: AnyPath | pd.DataFrame, header_line: int | None = None) -> Table:
    """Read a table, without comments, lines above its header and empty lines at its
    end.

    Raises
    ------
    OSError
        If the file cannot be read.
    ValueError
        If it is not a table.
    """
    if not isinstance(source, (str, PathLike)):
        rows = [list(map(str, row)) for row in source.itertuples(index=False)]
        return Table([*map(str, source.columns)], range(1, len(rows) + 1), rows, "")
    try:
        text = read_bytes(source).decode("utf-8-sig")
    except UnicodeDecodeError:
        raise ValueError("it is not UTF-8: save the table as CSV (UTF-8)") from None
    lines = {
        i: line
        for i, line in enumerate(re.split("\r\n?|\n", text), 1)
        if i == header_line or FAILED.match(line) or not COMMENT.match(line)
    }
    while lines and not lines[max(lines)].strip():
        lines.popitem()
    first = min(lines, default=1) if header_line is None else header_line
    if not lines.get(first, "").strip():
        raise ValueError(f"line {first} has no names of columns (see --header-line)")
    bare = re.sub('"[^"]*"', "", lines[first])
    separator = next((sign for sign in ";\t" if sign in bare), ",")
    below = {i: line for i, line in lines.items() if i >= first}
    reader = csv.reader(
        below.values(), delimiter=separator, skipinitialspace=True, strict=True
    )
    names, *rows = [[cell.strip() for cell in row] for row in reader]
    if len(rows) + 1 < len(below):
        raise ValueError("a quotation mark is not closed on its line")
    if len(names) == 1 and _is_value(names[0]) and header_line is None:
        return Table([], [*below], [names, *rows], separator)
    for cell in filter(_is_value, names):
        raise ValueError(f"line {first}: {cell!r} is no name; all columns need names")
    return Table(names, [*below][1:], rows, separator)


def read_series(
    source: AnyPath | pd.DataFrame,
    x: Quantity,
    ys: Sequence[Quantity],
    length: float,
    choice: Choice = BY_NAME,
    header_line: int | None = None,
    sample_rate: float | None = None,
) -> list[tuple[Quantity, Numbers]]:
    """Read x with each y that is chosen or named in the header, each of shape (rows,
    2).

    With a `sample_rate` [Hz], times are computed and the table must have none. For the
    other arguments see `read_table` and `Table.columns`.
    """
    with refusals_of(source):
        table = read_table(source, header_line)
        words = [_parts(name)[0] for name in table.names]
        if sample_rate is not None and (
            x.symbol in choice or any(map(x.is_named, words))
        ):
            raise ValueError("it has times: leave out --sample-rate")
        chosen = [y for y in ys if y.symbol in choice]
        named = [y for y in ys if any(map(y.is_named, words))]
        series = []
        for y in chosen or named or ys[:1]:
            needed = [x, y] if sample_rate is None else [y]
            columns = table.columns(needed, choice, length)
            if sample_rate is not None:
                times = np.arange(len(columns)) / sample_rate
                columns = np.column_stack([times, columns])
            series.append((y, columns))
        return series


def read_weights(
    path: AnyPath, choice: Choice = BY_NAME, header_line: int | None = None
) -> list[float]:
    """Read normal loads [N], one row per block; a column `block` may number the
    rows."""
    with refusals_of(path):
        table = read_table(path, header_line)
        weights = table.columns([WEIGHT], choice)[:, 0].tolist()
        for place, name in enumerate(table.names):
            blocks = [row[place] for row in table.rows]
            for i, block in enumerate(blocks if name.casefold() == "block" else [], 1):
                if block != str(i):
                    line = table.lines[i - 1]
                    raise ValueError(
                        f"line {line}: block must be {i}, but is {block!r}"
                    )
        return weights


def read_profile(
    path: AnyPath, choice: Choice = BY_NAME, header_line: int | None = None
) -> Numbers:
    """Read positions [m] from the pushed end and pressures in any unit, shape (2,
    rows).

    A single column is the pressure in equal cells, shape (1, rows).
    """
    with refusals_of(path):
        table = read_table(path, header_line)
        needed = [POSITION, PRESSURE] if len(table.names) > 1 else [PRESSURE]
        return table.columns(needed, choice).T


@contextmanager
def refusals_of(source: object) -> Iterator[None]:
    """Put the name of a table in front of an error message about it."""
    try:
        yield
    except (ValueError, csv.Error) as error:
        name = source if isinstance(source, (str, PathLike)) else "data"
        raise ValueError(f"{name}: {error}") from None


def _match(quantity: Quantity, names: Sequence[str], chosen: str) -> Match:
    """Find the column of a quantity: by the user's choice, or else by its name."""
    parts = [_parts(name) for name in names]
    wanted, chosen_unit = _parts(chosen)
    if chosen:
        exact = [name == chosen for name in names]
        alike = [
            wanted in (name, words, str(i))
            for i, (name, (words, _)) in enumerate(zip(names, parts, strict=True), 1)
        ]
    else:
        exact = [words in quantity.names for words, _ in parts]
        alike = [quantity.is_named(w) or u in quantity.units for w, u in parts]
    places = np.flatnonzero(exact if any(exact) else alike).tolist()
    if len(places) != 1:
        called = " or ".join(f"column {i + 1}, {names[i]!r}" for i in places)
        doubt = f"{quantity} may be {called}"
        if not called:
            doubt = f"no column is {chosen or quantity}"
        return Match(f"NAME [{quantity.unit}]", doubt=doubt)
    (place,) = places
    words, own_unit = parts[place]
    unit = own_unit if chosen == names[place] else chosen_unit or own_unit
    if words == LENGTH.symbol:
        unit = unit or LENGTH.unit
    doubt = ""
    if unit not in quantity.units:
        units = ", ".join(quantity.units)
        doubt = f"{names[place]!r} needs one of these units in brackets: {units}"
    if not chosen and not quantity.is_named(words):
        doubt = f"no column is {quantity}"
    added = "" if own_unit in quantity.units else f" [{quantity.unit}]"
    return Match(names[place] + added, place, unit, doubt)


def _parts(name: str) -> tuple[str, str]:
    """Split a name from the unit in brackets at its end."""
    parts = NAME_AND_UNIT.fullmatch(name)
    return (parts[1], re.sub("[µμ]", "u", parts[2])) if parts else (name, "")


def _is_value(cell: str) -> bool:
    """Whether a cell is a number or a failed formula, and hence not a name."""
    try:
        float(cell.replace(",", "."))
    except ValueError:
        return bool(FAILED.match(cell))
    return True
