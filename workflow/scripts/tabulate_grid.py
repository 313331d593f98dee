"""Gather the runs of the grid."""

from job import job, read_all, write_tables

from maegawa2010.studies.members import gather
from precursors.support.files import read_table

with job() as snakemake:
    chunks = read_all(read_table, snakemake.input.chunks)
    write_tables({"grid": gather(chunks.values())}, snakemake.output)
