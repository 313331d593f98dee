from maegawa2010.studies.resolution.tables import resolution_tables
from maegawa2010.support.job import job, read, read_all, write_tables
from precursors.support.files import read_table

with job() as snakemake:
    chunks = read_all(read_table, snakemake.input.chunks)
    noise = read(read_table, snakemake.input.noise)
    finer = [read_table(path) for path in snakemake.input.finer]
    tables = resolution_tables(chunks.values(), noise, finer)
    write_tables(tables, snakemake.output)
