"""Tabulate how often slip does not end, against the number of blocks."""

from pathlib import Path

from job import job

from precursors.ensembles.endless import endless_table
from precursors.support.files import read_table, write_table


def main(members: str | Path, length: float, output: str | Path) -> None:
    """Write a row per number of blocks: the share of runs without a global slip, and their pulse."""
    write_table(endless_table(read_table(members), length), output)


if __name__ == "__main__":
    with job() as snakemake:
        main(snakemake.input.members, snakemake.params.length, snakemake.output.table)
