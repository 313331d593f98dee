"""Tabulate what the number of blocks does to chains with viscosity and interface springs."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from job import job

from precursors.ensembles.catalogue import make_study
from precursors.ensembles.resolution_models import resolution_models_runs, resolution_models_table
from precursors.support.files import read_table, write_table


def main(
    config: Mapping[str, Any], name: str, members: str | Path, table: str | Path, runs: str | Path
) -> None:
    """Write a row per model, theta, N and number, and one per run and number, of the study of this name."""
    study, found = make_study(config, name), read_table(members)
    write_table(resolution_models_table(found, study), table)
    write_table(resolution_models_runs(found, study), runs)


if __name__ == "__main__":
    with job() as snakemake:
        main(
            snakemake.config,
            f"resolution_models{snakemake.wildcards.full}_members",
            snakemake.input.members,
            snakemake.output.table,
            snakemake.output.runs,
        )
