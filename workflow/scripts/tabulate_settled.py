"""Gather the settled runs of chains with a length, beside their law."""

from job import job, read_all, write_tables

from maegawa2010.studies.larger.cycles import settled_table
from precursors.support.files import read_table

with job() as snakemake:
    chunks = read_all(read_table, snakemake.input.chunks)
    table = settled_table(chunks.values(), snakemake.params.slider)
    write_tables({"settled": table}, snakemake.output)
