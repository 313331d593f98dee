"""Tabulate the apparent static friction coefficient (Eq. 1) under the definitions that could be meant."""

from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any

import pandas as pd
from job import job

from precursors.analysis.slips import DEFINITIONS, apparent_friction
from precursors.support.files import read_table, write_table

COLUMNS = ["scene", "definition", "mu_sapp", "load_N", "time_s", "event", "events_counted", "is_papers"]


def main(slips: Mapping[str, str | Path], output: str | Path) -> None:
    """Write one row per scene and definition, none where a scene has no global slip in that sense."""
    table = pd.DataFrame([row for scene, path in slips.items() for row in rows(scene, read_table(path))])
    write_table(table.rename(columns={"load": "load_N", "time": "time_s"}).reindex(columns=COLUMNS), output)


def rows(scene: str, slips: pd.DataFrame) -> list[dict[str, Any]]:
    """What each definition gives for a slip table."""
    found = [(definition, apparent_friction(slips, definition)) for definition in DEFINITIONS]
    return [
        {
            "scene": scene,
            "definition": definition.text,
            **asdict(friction),
            "is_papers": definition is DEFINITIONS[0],
        }
        for definition, friction in found
        if friction is not None
    ]


if __name__ == "__main__":
    with job() as snakemake:
        main(dict(zip(snakemake.params.scenes, snakemake.input.slips, strict=True)), snakemake.output.table)
