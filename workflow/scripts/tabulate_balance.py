"""Measure the mean of F_X in six runs, and what slips do to the distance from kinetic
balance."""

from job import job, write_tables

from maegawa2010.studies.balance.tables import balance_tables

with job() as snakemake:
    params = snakemake.params
    tables = balance_tables(params.sliders, params.n_blocks, params.duration)
    write_tables(tables, snakemake.output)
