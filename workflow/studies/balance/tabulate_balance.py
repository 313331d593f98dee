from maegawa2010.studies.balance.tables import balance_tables
from maegawa2010.support.job import job, write_tables

with job() as snakemake:
    params = snakemake.params
    tables = balance_tables(params.sliders, params.n_blocks, params.duration)
    write_tables(tables, snakemake.output)
