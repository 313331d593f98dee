"""The numbers of the paper's figures: what it prints, and what was reproduced."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import pandas as pd

from precursors.analysis.slip_rows import first_global

COLUMNS = ["scene", "theta", "quantity", "unit", "paper", "reproduced"]
COUNTED = "events counted in Fig. 13, the first global slip included"
FRICTION = "apparent static friction coefficient mu_sapp"


def reproduction_table(
    slips: Mapping[str, pd.DataFrame], mu_sapp: pd.DataFrame, paper: Mapping[str, Mapping[str, float]]
) -> pd.DataFrame:
    """One row per scene and quantity; `paper` is empty where the paper gives no number.

    Parameters
    ----------
    slips : mapping
        Slip table of each scene.
    mu_sapp : DataFrame
        tables/mu_sapp.csv, of all scenes.
    paper : mapping
        What the paper prints of each scene: events_counted and mu_sapp, or nothing.
    """
    papers = mu_sapp[mu_sapp["is_papers"].astype(bool)].set_index("scene")["mu_sapp"]
    rows = [
        (scene, next(iter(table["theta"]), None), quantity, unit, paper[scene].get(key), value)
        for scene, table in slips.items()
        for quantity, unit, key, value in quantities(table, papers.get(scene))
    ]
    return pd.DataFrame(rows, columns=COLUMNS)


def quantities(slips: pd.DataFrame, mu_sapp: float | None) -> Iterator[tuple[str, str, str, float | None]]:
    """Quantity, unit, key in `paper` (empty: none), and value (None without a global slip)."""
    yield COUNTED, "1", "events_counted", float(slips["counted"].sum())
    yield FRICTION, "1", "mu_sapp", mu_sapp
    number = first_global(slips)
    time, load = (None, None) if number is None else slips[["onset_s", "load_before_N"]].iloc[number]
    yield "time of the first global slip", "s", "", time
    yield "load at the first global slip", "N", "", load
    yield "all events up to the first global slip", "1", "", None if number is None else number + 1
