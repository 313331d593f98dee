"""Judge the paper's claims by the tables."""

from job import job, read_all, write_tables

from maegawa2010.paper.claims import claims_tables
from precursors.support.files import read_table

with job() as snakemake:
    tables = read_all(read_table, snakemake.input.tables)
    write_tables(claims_tables(tables), snakemake.output)
