"""Tables of numbers as spreadsheets and instruments write them: what cannot be
understood for certain is refused."""

from __future__ import annotations

import csv
import math
import re
import unicodedata
import warnings
from collections.abc import Sequence
from itertools import islice, takewhile, zip_longest
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from precursors.support.files import AnyPath

if TYPE_CHECKING:
    import pandas as pd

# The name of each column, and its fields from top to bottom.
Columns = list[tuple[str, tuple[str, ...]]]

NUMBER = re.compile(r"[-+]?(\d+([.,]\d*)?|[.,]\d+)([eE][-+]?\d{1,3})?")
GROUPED = re.compile(r"[-+]?\d{1,3}([.,'\u2019\s]\d{3})+([.,]\d+)?")
# A date or none, hours, minutes, seconds.
STAMP = re.compile(r"(?:(\S+)[ T])?(\d{1,2}):(\d\d):(\d\d(?:[.,]\d*)?)Z?")
DAY = 86_400.0  # [s]
# Empty lines, sep=; and comments; an error of a spreadsheet, such as #N/A or #DIV/0!, is
# no comment.
PASSED_OVER = re.compile(r'(?:[\t;,"]*|"?sep=."?)$|#(?!N/A|NV|[A-Z/0]+[!?])')
# A line of names begins with one, and has no number between separators.
NAMES = re.compile(
    r"(?!nan|inf|n/?a\b)[\s;,\"\[(]*[^\W\d](?!.*(?<![\w\[(^])[-+]?[.,]?\d)",
    re.IGNORECASE,
)
# Files of LabVIEW name the units of the channels above this line.
END_OF_HEADER = "***End_of_Header***"
CHANNEL_UNITS = "Y_Unit_Label"
# Commas between columns: beside a decimal point or a blank, or several in a line. The
# point of 1.018,00 is none.
SEPARATING = re.compile(r"(?<=\b0)\.|\.(?!\d{3},)|,[^\S\n]|,[^,\n]*,")
# Only accented Latin letters: in other encodings, a name or a unit is not what it seems.
NOT_LATIN = re.compile(r"[^\x00-\x7f\xa0µÀ-ÖØ-öø-ÿ]")
# The columns that are read here,
TIME = "t [s]"
LOAD = "F_X [N]"
LENGTH = "L_p/L [-]"
NORMAL_LOAD = "normal load of each block [N]"
PROFILE = "pressure or load, in any unit"
# their own names and words for them,
_LOADS = r"f|load|force|fuerza|forza|last|[^\W\d_]*kraft"
WORDS = {
    TIME: ("t|x_value", "time(?:stamp)?|zeit(?:stempel)?|temps|tiempo|tempo"),
    LOAD: ("f_?x|tangential[a-z]*|friction", _LOADS),
    LENGTH: ("l_?p", "l|length|länge|longueur"),
    NORMAL_LOAD: ("w", _LOADS),
    PROFILE: ("p", rf"pressure|[^\W\d_]*druck|pression|presión|pressione|{_LOADS}"),
}
WHOLE_WORD = r"(?<![^\W\d_])({})(?![^\W\d_])"
ANY_WORD = re.compile(
    WHOLE_WORD.format("|".join(sum(WORDS.values(), ()))), re.IGNORECASE
)
# and how many of the unit above their units are.
_NEWTONS = {"N|(?i:newtons?)": 1.0, "kN": 1e3, "mN": 1e-3}
UNITS = {
    TIME: {
        r"s|(?i:secs?|seconds?|sekunden?|secondes?|segundos?|second[io])": 1.0,
        r"ms|(?i:msecs?|milliseconds?|millisekunden?)": 1e-3,
        r"[uμ]s|(?i:usecs?|microseconds?)": 1e-6,
        r"min|(?i:mins|minut[eo]s?|minuten|minuti)": 60.0,
    },
    LOAD: _NEWTONS,
    LENGTH: {"1|-": 1.0, "%": 0.01},
    NORMAL_LOAD: _NEWTONS,
    PROFILE: {r"[kM]?N|[hkM]?Pa|m?bar|psi|k?gf?|lbf?|m?V|\w+/[cm]?m2": 1.0},
}
BRACKET = re.compile(r"[\[({]\s*([^\])}]*?)\s*[\])}]")
# Units without a bracket. A single letter after an underscore is a name, as in Load_A.
_OTHER = (
    "MN|daN|kgf?|gf|grams?|lbs?|lbf|N/mm2|Nm|[hkM]?Pa|psi|m?bar|[uμm]V|volts?|[cmuμ]?m"
)
_BARE = "|".join([*UNITS[TIME], *_NEWTONS, "h", _OTHER])
BARE = re.compile(rf"(?:^|[\s_,/])({_BARE})(?=$|[\s_,])|[,/]\s*([gAV])$")


def read_columns(
    source: AnyPath | pd.DataFrame,
    needed: Sequence[str],
    sample_rate: float | None = None,
    names: Sequence[str] = (),
) -> NDArray[np.float64]:
    """Read columns of numbers, keys of `WORDS`: by `names`, or by their units and
    names, or in this order.

    A file may have lines of names; commas, semicolons, tabs or blanks between columns;
    decimal commas; time stamps; and other lines above the names. Empty columns and
    lines, and lines that begin with #, are passed over. Values are converted to the
    unit needed; a warning tells this, and how many lines lack a value.

    Parameters
    ----------
    source : path or DataFrame
        The table.
    needed : sequence of str
        Which columns.
    sample_rate : float, optional
        Lines per second [Hz], for a table without a column of times.
    names : sequence of str, optional
        Their names in the table, or what only these names contain.

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
    wanted = [kind for kind in needed if kind != TIME or sample_rate is None]
    lines, columns = _fields(source, wanted)
    path = _name(source)
    places = _places(path, lines, columns, wanted, names)
    rows = list(zip(*(columns[i][1] for i in places), strict=True))
    kept = [k for k, row in enumerate(rows) if all(row)]
    if len(kept) < len(rows):
        warnings.warn(
            f"{path}: lines without a value, left out: {len(rows) - len(kept)}",
            stacklevel=2,
        )
    chosen = [(columns[i][0], tuple(columns[i][1][k] for k in kept)) for i in places]
    numbers = _numbers(path, [lines[k] for k in kept], chosen, wanted)
    if len(wanted) < len(needed):
        return np.column_stack([np.array(kept) / sample_rate, numbers])
    return numbers


def read_weights(path: AnyPath) -> list[float]:
    """Normal loads [N], a number for each block, alone or after the number or name of
    the block: 1 or b1, 2 or b2."""
    lines, columns = _fields(path, [NORMAL_LOAD])
    if len(lines) == 1 and len(columns) > 2:  # a table of one line, as of the explorer
        name = " ".join(name for name, _ in columns)
        columns = [(name, tuple(field for _, (field,) in columns))]
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
    [place] = _places(path, lines, columns, [NORMAL_LOAD])
    return list(
        map(float, _numbers(path, lines, [columns[place]], [NORMAL_LOAD])[:, 0])
    )


def read_profile(path: AnyPath) -> NDArray[np.float64]:
    """The shape of a pressure or load, a line for each position from the trailing edge
    on: a matrix without names, or one column of a table with names.

    Returns
    -------
    ndarray, shape (number of lines, number of columns)
    """
    lines, columns = _fields(path, [PROFILE])
    if len({name for name, _ in columns}) > 1:
        [place] = _places(path, lines, columns, [PROFILE])
        columns = [columns[place]]
    numbers = _numbers(path, lines, columns, [PROFILE] * len(columns))
    steps = np.diff(numbers[:, 0])
    if len(columns) > 1 < len(steps) and 0 < steps.max() < 1.0001 * steps.min():
        raise ValueError(f"{path}: leave out the first column, which holds positions")
    return numbers


def _name(source: AnyPath | pd.DataFrame) -> str:
    return "data" if hasattr(source, "to_csv") else str(source)


def _text(source: AnyPath | pd.DataFrame) -> str:
    """The table as text."""
    if not isinstance(source, str) and hasattr(source, "to_csv"):
        has_names = all(isinstance(name, str) for name in source.columns)
        return source.to_csv(sep=";", index=False, header=has_names)
    content = Path(source).read_bytes()
    if b"\0" in content:
        raise ValueError(
            f"{source} is not plain text: in the spreadsheet, save the table as CSV (UTF-8)"
        )
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError:
        text = content.decode("latin-1")
    if found := NOT_LATIN.search(text):
        line = text.count("\n", 0, found.start()) + 1
        raise ValueError(f"{source}, line {line}: not UTF-8: save it as CSV (UTF-8)")
    return text


def _fields(
    source: AnyPath | pd.DataFrame, needed: Sequence[str]
) -> tuple[list[int], Columns]:
    """Numbers of the lines of a table, and its columns, without empty ones."""
    path = _name(source)
    text = _text(source)
    lines = {
        n: line
        for n, whole in enumerate(text.splitlines(), 1)
        if not PASSED_OVER.match(line := whole.strip(" \u00a0"))
    }
    written = list(lines.values())
    start = _start(written, needed)
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
    if not heads and (comment := re.search(r"(?m)^#(.*)\n(?=[-+.,\d\s\"])", text)):
        heads = [
            head
            for head in [_cut(comment[1].strip(), separator)]
            if len(head) == len(columns)
        ]
    for labels in written[:start]:  # of LabVIEW
        if labels.startswith(CHANNEL_UNITS):
            heads.append(["", *_cut(labels, separator)[1:]])
    parts = zip_longest([""] * len(columns), *_heads(heads, len(columns)), fillvalue="")
    names = (" ".join(filter(None, part)) for part in parts)
    named = zip(names, columns, strict=False)
    numbers = list(lines)[start + len(above) :]
    return numbers, [(name, column) for name, column in named if any(column)]


def _start(lines: Sequence[str], needed: Sequence[str]) -> int:
    """Where a table begins: below LabVIEW's header, or at the first line that names
    what is needed, if no numbers stand above it."""
    ends = [i for i, line in enumerate(lines) if line.startswith(END_OF_HEADER)]
    if ends:
        return ends[-1] + 1
    for i, line in enumerate(lines):
        cells = [(cell.strip(), ()) for cell in re.split(r"[;,\t]", line)]
        if all(NUMBER.fullmatch(cell) or STAMP.fullmatch(cell) for cell, _ in cells):
            break
        if NAMES.match(line) and all(_candidates(cells, kind) for kind in needed):
            return i - len(list(takewhile(NAMES.match, lines[:i][::-1])))
    return 0


def _heads(heads: Sequence[list[str]], width: int) -> list[list[str]]:
    """Lines of names, with brackets around what is a line of units; of a title above
    all columns, the units."""
    found = []
    is_named = False
    for head in heads:
        if any(re.search(ANY_WORD, BRACKET.sub("", cell)) for cell in head):
            is_named = True
        elif is_named or any(BARE.fullmatch(cell) for cell in head):
            head = [cell and f"[{cell.strip('[({})] ')}]" for cell in head]
        if len(head) == 1 < width:
            head = ["".join(f"[{unit}]" for unit in _units(head[0]))] * width
        found.append(head)
    return found


def _separator(path: str, above: Sequence[str], rows: Sequence[str]) -> str:
    """Separator of two columns: a blank is any space, and a semicolon stands for a
    single column."""
    for separator in ";\t":
        if separator in "".join((*above, *rows)):
            return separator
    plain = re.sub(r'"[^"\n]*"', '""', "\n".join(rows))
    if "," not in plain:
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


def _places(
    path: str,
    lines: Sequence[int],
    columns: Columns,
    needed: Sequence[str],
    names: Sequence[str] = (),
) -> list[int]:
    """Which columns are needed."""
    if names:
        places = [
            [i for i, (name, _) in enumerate(columns) if name == wanted]
            or [i for i, (name, _) in enumerate(columns) if wanted in name]
            for wanted in names
        ]
    else:
        places = [_candidates(columns, kind) for kind in needed]
    if len(columns) == len(needed):
        others = iter(sorted(set(range(len(columns))).difference(*places)))
        places = [found or list(islice(others, 1)) for found in places]
    chosen = [i for found in places for i in found]
    if not len(chosen) == len(set(chosen)) == len(needed) == sum(map(bool, places)):
        told = ", ".join(repr(name) for name, _ in columns if name)
        raise ValueError(
            f"{path}, line {lines[0]}: columns: {len(columns)} {told}".rstrip()
            + f"; needed: {', '.join(names or needed)}"
        )
    return chosen


def _candidates(columns: Columns, kind: str) -> list[int]:
    """Columns that this may be: those of its unit, of its own name, of a word for
    it."""
    places: list[int] = []
    for is_meant in (
        lambda name: _factors(name, kind),
        *(
            re.compile(WHOLE_WORD.format(words), re.IGNORECASE).search
            for words in WORDS[kind]
        ),
    ):
        rest = places or range(len(columns))
        places = [i for i in rest if is_meant(columns[i][0])] or places
    return places


def _numbers(
    path: str, lines: Sequence[int], columns: Columns, needed: Sequence[str]
) -> NDArray[np.float64]:
    """Numbers of columns in the units that are needed."""
    numbers = []
    digits = ""
    for (name, fields), kind in zip(columns, needed, strict=True):
        stamps = [STAMP.fullmatch(field) for field in fields]
        if kind == TIME and all(stamps):
            numbers.append(_seconds(path, stamps))
            continue
        factors = _factors(name, kind) if _units(name) else {1.0}
        if len(factors) != 1:
            unit = ", ".join(_units(name))
            raise ValueError(
                f"{path}: the column {name!r} is in {unit}; needed: {kind}"
            )
        [factor] = factors
        if factor != 1:
            warnings.warn(f"{path}: {name!r} is converted to {kind}", stacklevel=3)
        values = [_number(path, *where) for where in zip(lines, fields, strict=True)]
        numbers.append(factor * np.array(values))
        digits += "".join(fields)
    if {",", "."} <= set(digits):
        raise ValueError(f"{path} has decimal commas and decimal points: write one")
    return np.column_stack(numbers)


def _seconds(path: str, stamps: Sequence[re.Match[str]]) -> NDArray[np.float64]:
    """Seconds since the first of time stamps less than half a day apart."""
    clock = [
        3600 * int(h) + 60 * int(m) + float(s.replace(",", "."))
        for _, h, m, s in (stamp.groups() for stamp in stamps)
    ]
    seconds = np.unwrap(clock, period=DAY)
    dates = {stamp[1] for stamp in stamps} - {None}
    if dates and len(dates) != len(set(seconds // DAY)):
        raise ValueError(f"{path}: the time stamps leave out half a day or more")
    return seconds - seconds[0]


def _units(name: str) -> list[str]:
    """Whatever stands as a unit in the name of a column: in brackets, or else a known
    unit."""
    name = unicodedata.normalize("NFKC", name)
    bare = (found[1] or found[2] for found in BARE.finditer(name))
    return list(filter(None, BRACKET.findall(name))) or list(bare)


def _factors(name: str, kind: str) -> set[float]:
    """How many of the unit of a kind of column the units in a name are."""
    return {
        factor
        for unit in _units(name)
        for pattern, factor in UNITS[kind].items()
        if re.fullmatch(pattern, unit)
    }


def _number(path: str, line: int, field: str) -> float:
    """The number that a field holds."""
    value = field.replace(",", ".")
    if NUMBER.fullmatch(field) and math.isfinite(float(value)):
        return float(value)
    is_grouped = GROUPED.fullmatch(field)
    why = "has a separator of thousands" if is_grouped else "is not a number"
    raise ValueError(f"{path}, line {line}: {field[:40]!r} {why}")
