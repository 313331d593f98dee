"""Tabulate what the paper prints beside what was reproduced."""

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import pandas as pd
from job import job
from tables import read_table, write_table

COLUMNS = ["scene", "theta", "quantity", "unit", "paper", "reproduced"]


def main(
    slips: Mapping[str, str | Path],
    mu_sapp: str | Path,
    theta: Mapping[str, float],
    paper: Mapping[str, Mapping[str, float]],
    output: str | Path,
) -> None:
    """Write one row per scene and quantity; `paper` stays empty where the paper gives no number."""
    friction = read_table(mu_sapp)
    papers = friction[friction["is_papers"].astype(bool)].set_index("scene")["mu_sapp"]
    rows = [
        (scene, theta[scene], quantity, unit, paper[scene].get(key), value)
        for scene, path in slips.items()
        for quantity, unit, key, value in quantities(read_table(path), papers.get(scene))
    ]
    write_table(pd.DataFrame(rows, columns=COLUMNS), output)


def quantities(slips: pd.DataFrame, mu_sapp: float | None) -> Iterator[tuple[str, str, str, Any]]:
    """What a scene is compared by: quantity, unit, key in the configuration, value (None: no global slip)."""
    found = slips["is_global"].any()
    number = int(slips["is_global"].argmax()) if found else 0
    yield "events kept, the first global slip included", "1", "events_kept", slips["kept"].sum()
    yield "apparent static friction coefficient mu_sapp", "1", "mu_sapp", mu_sapp
    first = slips.iloc[number] if found else pd.Series(dtype=float)
    yield "time of the first global slip", "s", "global_slip_time", first.get("onset_s")
    yield "load at the first global slip", "N", "global_slip_load", first.get("load_before_N")
    yield "all events up to the first global slip", "1", "events", number + 1 if found else None


if __name__ == "__main__":
    with job() as snakemake:
        main(
            dict(zip(snakemake.params.theta, snakemake.input.slips, strict=True)),
            snakemake.input.mu_sapp,
            snakemake.params.theta,
            snakemake.params.paper,
            snakemake.output.table,
        )
