"""Tabulate what small changes make of the numbers of a scene, and how far these can be trusted."""

from pathlib import Path

from job import job

from precursors.ensembles.spread import robustness_table, spread_table
from precursors.support.files import read_table, write_table


def main(members: str | Path, spread: str | Path, robustness: str | Path) -> None:
    """Write a row per ensemble and number, and a row per scene and number."""
    table = spread_table(read_table(members))
    write_table(table, spread)
    write_table(robustness_table(table), robustness)


if __name__ == "__main__":
    with job() as snakemake:
        main(snakemake.input.members, snakemake.output.spread, snakemake.output.robustness)
