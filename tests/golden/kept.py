"""Small tables and pictures that are kept: what the library gives must be the same.

A test file has those of its subject in TABLES and PICTURES; `make golden` replaces what
is kept.
"""

from __future__ import annotations

from importlib import import_module
from pathlib import Path
from typing import Any
from unittest import mock

import numpy as np
import pandas as pd

from precursors.figures import style

GOLDEN = Path(__file__).parent
SMALL = GOLDEN / "small"
# Times and loads of a run are right to 1e-9 s and 1e-6 N whatever the processor, and so
# are their statistics.
ROUNDING = 1e-8
# A method with steps is off by the roundings of some 1e6 steps; errors relative to the
# paper's chain are differences of numbers near one; energy that a larger chain lacks is
# of the size of roundings.
RELATIVE = {"definitions": 1e-6}
ABSOLUTE = {"model_comparison": 1e-12, "larger_runs": 1e-12}


def kept(kind: str) -> dict[str, Any]:
    """All that the test files keep of a kind, "TABLES" or "PICTURES", by name."""
    found: dict[str, Any] = {}
    for file in sorted(GOLDEN.parent.glob("*/test_*.py")):
        if f"\n{kind} = {{" in file.read_text(encoding="utf-8"):
            module = import_module(f"{file.parent.name}.{file.stem}")
            found |= getattr(module, kind)
    return found


def write_table(name: str, table: pd.DataFrame) -> None:
    """Keep a table, without its costs, with all digits that matter."""
    _without_costs(table).to_csv(
        SMALL / f"{name}.csv", index=False, float_format="%.12g"
    )


def assert_table(name: str, table: pd.DataFrame) -> None:
    """The table is the one that is kept: words and counts exactly, numbers within a
    tolerance."""
    kept = pd.read_csv(SMALL / f"{name}.csv")
    found = _without_costs(table)
    assert list(found.columns) == list(kept.columns)
    assert len(found) == len(kept)
    for column in kept:
        new, old = found[column], kept[column]
        if any(map(pd.api.types.is_float_dtype, (new, old))):
            np.testing.assert_allclose(
                new.astype(float),
                old,
                RELATIVE.get(name, ROUNDING),
                ABSOLUTE.get(name, 0.0),
                err_msg=column,
            )
        else:
            words = [values.fillna("").astype(str).tolist() for values in (new, old)]
            assert words[0] == words[1], column


def write_picture(path: Path, how: Any) -> None:
    """Write a picture of few pixels; `how` draws it, or draws it with a look."""
    draw, look = how if isinstance(how, tuple) else (how, style.LOOK)
    with mock.patch.object(style, "PNG_DPI", 60):
        style.save(draw(), path, look)


def _without_costs(table: pd.DataFrame) -> pd.DataFrame:
    return table.drop(columns=[name for name in table if name.startswith("cost")])
