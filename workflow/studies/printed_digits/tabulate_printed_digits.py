from maegawa2010.studies.printed_digits.tables import digits_tables
from maegawa2010.support.job import job, read_all, write_tables
from precursors.support.files import read_table

with job() as snakemake:
    chunks = read_all(read_table, snakemake.input.chunks)
    tables = digits_tables(chunks.values(), snakemake.params.paper)
    write_tables(tables, snakemake.output)
