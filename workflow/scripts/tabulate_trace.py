"""Tabulate the tangential load so that straight lines between the rows draw it."""

from pathlib import Path

from job import job
from tables import write_table

from precursors.run import Run
from precursors.tables import load_trace


def main(run: str | Path, output: str | Path) -> None:
    """Write the exact F_X at the start, at every transition, at points inside every slip, and at the end."""
    write_table(load_trace(Run.load(run)), output)


if __name__ == "__main__":
    with job() as snakemake:
        main(snakemake.input.run, snakemake.output.table)
