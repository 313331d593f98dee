"""Tabulate how far the digits that the paper prints settle its numbers."""

from job import job

from precursors.ensembles.printed_digits import digits_table
from precursors.support.files import read_table, write_table

if __name__ == "__main__":
    with job() as snakemake:
        members = read_table(snakemake.input.members)
        write_table(digits_table(members, snakemake.params.paper), snakemake.output.table)
