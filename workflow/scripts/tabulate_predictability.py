"""Tabulate the predictability time of chains of more and more blocks, without noise."""

from job import job

from precursors.ensembles.resolution import predictability_table
from precursors.support.files import write_table

if __name__ == "__main__":
    with job() as snakemake:
        write_table(predictability_table(**dict(snakemake.params.items())), snakemake.output.table)
