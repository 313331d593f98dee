"""Tabulate what the paper prints beside what was reproduced."""

from collections.abc import Mapping
from pathlib import Path

from job import job

from precursors.reproduction.scene_numbers import reproduction_table
from precursors.support.files import read_table, write_table


def main(
    slips: Mapping[str, str | Path],
    mu_sapp: str | Path,
    paper: Mapping[str, Mapping[str, float]],
    output: str | Path,
) -> None:
    """Write one row per scene and quantity; `paper` stays empty where the paper gives no number."""
    tables = {scene: read_table(path) for scene, path in slips.items()}
    write_table(reproduction_table(tables, read_table(mu_sapp), paper), output)


if __name__ == "__main__":
    with job() as snakemake:
        main(
            dict(zip(snakemake.params.paper, snakemake.input.slips, strict=True)),
            snakemake.input.mu_sapp,
            snakemake.params.paper,
            snakemake.output.table,
        )
