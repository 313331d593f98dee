"""Tabulate the predictability time of chains of more and more blocks, without noise."""

from job import job

from precursors.ensembles.resolution import predictability_table
from precursors.support.files import write_table

if __name__ == "__main__":
    with job() as snakemake:
        options = {name: value for name, value in snakemake.params.items() if name != "code"}
        write_table(predictability_table(**options), snakemake.output.table)
