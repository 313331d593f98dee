"""How results are written: text for people, one JSON value for machines."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import pandas as pd


def print_json(value: object) -> None:
    """Write one JSON value; NaN, which JSON does not have, becomes null."""
    print(json.dumps(_plain(value), indent=1, allow_nan=False))


def print_table(table: pd.DataFrame) -> None:
    """Write a table for reading, ten digits a number."""
    if table.empty:
        print("no rows")
    else:
        print(table.to_string(index=False, na_rep="-", float_format="{:.10g}".format))


def print_values(values: Mapping[str, object]) -> None:
    """Write named values in two columns, ten digits a number."""
    width = max(map(len, values))
    for name, value in values.items():
        print(f"{name:<{width}}  {_text(value)}")


def records(table: pd.DataFrame) -> list[dict[str, Any]]:
    """Rows of a table as dictionaries."""
    return [{str(name): value for name, value in row.items()} for row in table.to_dict(orient="records")]


def _text(value: object) -> str:
    if isinstance(value, float):
        return "-" if math.isnan(value) else f"{value:.10g}"
    return str(value)


def _plain(value: object) -> object:
    """The same in the types that JSON knows."""
    if isinstance(value, Mapping):
        return {str(key): _plain(inner) for key, inner in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(inner) for inner in value]
    if hasattr(value, "item"):
        value = value.item()  # a NumPy scalar
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value if isinstance(value, str | int | float | bool | None) else str(value)
