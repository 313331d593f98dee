"""Small tables and pictures that are kept: what the library gives must be the same.

A test file has the pictures of its subject in PICTURES; `make golden` replaces what is
kept.
"""

from __future__ import annotations

from importlib import import_module
from io import StringIO
from pathlib import Path
from typing import Any
from unittest import mock

import pandas as pd

from precursors.figures import style

GOLDEN = Path(__file__).parent
SMALL = GOLDEN / "small"
# Times and loads of a run are right to 1e-9 s and 1e-6 N whatever the processor, and so
# are their statistics.
ROUNDING = 1e-8
# Errors relative to the paper's chain are differences of numbers near one, as small as
# roundings.
ABSOLUTE = 1e-12


def pictures() -> dict[str, Any]:
    """All pictures that test files keep, by name."""
    found: dict[str, Any] = {}
    for file in sorted(GOLDEN.parent.glob("*/test_*.py")):
        if "\nPICTURES = {" in file.read_text(encoding="utf-8"):
            module = import_module(f"{file.parent.name}.{file.stem}")
            found |= module.PICTURES
    return found


def write_table(name: str, table: pd.DataFrame) -> None:
    """Keep a table."""
    (SMALL / f"{name}.csv").write_text(_text(table), encoding="utf-8")


def assert_table(name: str, table: pd.DataFrame) -> None:
    """The table is the one that is kept, numbers within a tolerance."""
    found, kept = map(pd.read_csv, (StringIO(_text(table)), SMALL / f"{name}.csv"))
    pd.testing.assert_frame_equal(found, kept, rtol=ROUNDING, atol=ABSOLUTE)


def _text(table: pd.DataFrame) -> str:
    """The table with all digits that matter."""
    return table.to_csv(index=False, float_format="%.12g")


def write_picture(path: Path, how: Any) -> None:
    """Write a picture of few pixels; `how` draws it, or draws it with a look."""
    draw, look = how if isinstance(how, tuple) else (how, style.LOOK)
    with mock.patch.object(style, "PNG_DPI", 60):
        style.save(draw(), path, look)
