from maegawa2010.studies.noise.tables import noise_tables
from maegawa2010.support.job import job, read_all, write_tables
from precursors.support.files import read_table

with job() as snakemake:
    chunks = read_all(read_table, snakemake.input.chunks)
    write_tables(noise_tables(chunks.values()), snakemake.output)
