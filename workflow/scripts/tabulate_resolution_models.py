"""Tabulate what the number of blocks does to chains with viscosity and interface springs."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from job import job
from tables import read_table, write_table

from precursors.ensembles.catalogue import make_study
from precursors.ensembles.resolution_models import resolution_models_table


def main(config: Mapping[str, Any], members: str | Path, output: str | Path) -> None:
    """Write a row per model, theta, N and number."""
    study = make_study(config, "resolution_models_members")
    write_table(resolution_models_table(read_table(members), study), output)


if __name__ == "__main__":
    with job() as snakemake:
        main(snakemake.config, snakemake.input.members, snakemake.output.table)
