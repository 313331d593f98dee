"""Tabulate what the ledger asks of the scenes and no other table holds."""

from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path

import pandas as pd
from job import job

from precursors.reproduction.measures import measures
from precursors.solver.run import Run
from precursors.support.files import write_table

COLUMNS = ["scene", "quantity", "block", "unit", "value"]


def main(runs: Mapping[str, str | Path], output: str | Path) -> None:
    """Write one row per scene and number; `block` is empty where a number is not one block's."""
    rows = [
        {"scene": scene, **asdict(found)}
        for scene, path in runs.items()
        for found in measures(Run.load(path))
    ]
    write_table(pd.DataFrame(rows, columns=COLUMNS).astype({"block": "Int64"}), output)


if __name__ == "__main__":
    with job() as snakemake:
        main(dict(zip(snakemake.params.scenes, snakemake.input.runs, strict=True)), snakemake.output.table)
