"""Tabulate what small changes make of the numbers of a scene, and how far these can be trusted."""

from job import job

from precursors.ensembles.spread import robustness_table, spread_table
from precursors.support.files import read_table, write_table

if __name__ == "__main__":
    with job() as snakemake:
        table = spread_table(read_table(snakemake.input.members))
        write_table(table, snakemake.output.spread)
        write_table(robustness_table(table), snakemake.output.robustness)
