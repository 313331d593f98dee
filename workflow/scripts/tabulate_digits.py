"""Tabulate how far the digits that the paper prints settle its numbers."""

from gather_members import gathered
from job import job

from precursors.ensembles.printed_digits import digits_table
from precursors.support.files import write_table

if __name__ == "__main__":
    with job() as snakemake:
        members = gathered(snakemake)
        write_table(digits_table(members, snakemake.params.paper), snakemake.output.table)
