"""What the paper prints beside what was reproduced."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import pandas as pd

from precursors.analysis.slip_rows import first_global

COLUMNS = ["scene", "theta", "quantity", "unit", "paper", "reproduced"]


def reproduction_table(
    slips: Mapping[str, pd.DataFrame],
    mu_sapp: pd.DataFrame,
    paper: Mapping[str, Mapping[str, float]],
) -> pd.DataFrame:
    """One row per scene and quantity; `paper` stays empty where the paper gives no number.

    Parameters
    ----------
    slips : mapping
        Scene to slip table (tables/{scene}_slips.csv), which has theta too.
    mu_sapp : DataFrame
        tables/mu_sapp.csv, of all scenes.
    paper : mapping
        Scene to what the paper prints of it: events_kept and mu_sapp, or nothing.
    """
    papers = mu_sapp[mu_sapp["is_papers"].astype(bool)].set_index("scene")["mu_sapp"]
    rows = [
        (scene, next(iter(table["theta"]), None), quantity, unit, paper[scene].get(key), value)
        for scene, table in slips.items()
        for quantity, unit, key, value in quantities(table, papers.get(scene))
    ]
    return pd.DataFrame(rows, columns=COLUMNS)


def quantities(slips: pd.DataFrame, mu_sapp: float | None) -> Iterator[tuple[str, str, str, float | None]]:
    """Quantity, unit, its key in `paper` (empty: none), and its value (None without a global slip)."""
    yield "events kept, the first global slip included", "1", "events_kept", float(slips["kept"].sum())
    yield "apparent static friction coefficient mu_sapp", "1", "mu_sapp", mu_sapp
    number = first_global(slips)
    time, load = (None, None) if number is None else slips[["onset_s", "load_before_N"]].iloc[number]
    yield "time of the first global slip", "s", "", time
    yield "load at the first global slip", "N", "", load
    events = None if number is None else number + 1
    yield "all events up to the first global slip", "1", "", events
