"""Tabulate what the number of blocks does to the paper's numbers, and where they go as it grows."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from job import job

from precursors.ensembles.resolution import extrapolation_table, resolution_table, with_estimates
from precursors.support.files import read_table, write_table


def main(
    members: str | Path, slider: Mapping[str, Any], fit_from: int, table: str | Path, limits: str | Path
) -> None:
    """Write a row per scene, N and number, and the law of each number for chains of `fit_from` blocks on."""
    resolution = with_estimates(resolution_table(read_table(members), slider["length"]), slider)
    write_table(resolution, table)
    write_table(extrapolation_table(resolution, fit_from), limits)


if __name__ == "__main__":
    with job() as snakemake:
        main(
            snakemake.input.members,
            snakemake.params.slider,
            snakemake.params.fit_from,
            snakemake.output.table,
            snakemake.output.limits,
        )
