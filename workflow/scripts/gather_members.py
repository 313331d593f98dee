"""Gather the chunks of a study in one table: one row per member."""

from job import job

from precursors.ensembles.study import gather
from precursors.support.files import write_table

if __name__ == "__main__":
    with job() as snakemake:
        write_table(gather(snakemake.input.chunks), snakemake.output.table)
