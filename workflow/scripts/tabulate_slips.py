"""Tabulate the slip events of a run: when, under which load, how far."""

from pathlib import Path

from job import job

from precursors.analysis.slips import slip_table
from precursors.solver.run import Run
from precursors.support.files import write_table


def main(run: str | Path, output: str | Path) -> None:
    """Write every slip event; `counted` tells the rows of Fig. 13."""
    write_table(slip_table(Run.load(run)), output)


if __name__ == "__main__":
    with job() as snakemake:
        main(snakemake.input.run, snakemake.output.table)
