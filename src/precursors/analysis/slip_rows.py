"""Rows of a slip table: its first global slip, and what leads up to it."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import pandas as pd


def first_global(slips: pd.DataFrame) -> int | None:
    """Row number of the first global slip by the column `is_global`; None without
    one."""
    is_global = slips["is_global"].to_numpy(bool)
    return int(is_global.argmax()) if is_global.any() else None


def up_to_first_global(slips: pd.DataFrame) -> pd.DataFrame:
    """Rows up to and including the first global slip; all without one."""
    first = first_global(slips)
    return slips if first is None else slips.iloc[: first + 1]
