"""Gather the settled runs of chains with a length."""

from job import job, read_all, write_tables

from maegawa2010.studies.larger.cycles import settled_table
from precursors.support.files import read_table

with job() as snakemake:
    chunks = read_all(read_table, snakemake.input.chunks)
    write_tables({"settled": settled_table(chunks.values())}, snakemake.output)
