"""Tabulate how far the digits that the paper prints settle its numbers."""

from pathlib import Path

from job import job

from precursors.ensembles.digits import digits_table
from precursors.support.files import read_table, write_table


def main(members: str | Path, output: str | Path) -> None:
    """Write a row per scene and number, and two on the agreement of the scenes."""
    write_table(digits_table(read_table(members)), output)


if __name__ == "__main__":
    with job() as snakemake:
        main(snakemake.input.members, snakemake.output.table)
