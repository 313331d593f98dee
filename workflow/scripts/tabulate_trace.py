"""Tabulate the tangential load so that straight lines between the rows draw it."""

from pathlib import Path

from job import job

from precursors.analysis.load_curve import load_trace
from precursors.solver.run import Run
from precursors.support.files import write_table


def main(run: str | Path, output: str | Path) -> None:
    """Write points of the exact F_X between which it is straight to 1e-4 N, every transition among them."""
    write_table(load_trace(Run.load(run)), output)


if __name__ == "__main__":
    with job() as snakemake:
        main(snakemake.input.run, snakemake.output.table)
