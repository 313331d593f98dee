"""Measure the time mean of F_X under many loadings and drives."""

from job import job, write_tables

from maegawa2010.studies.mean_load.tables import mean_load_table

with job() as snakemake:
    table = mean_load_table(snakemake.params.slider, snakemake.params.settings)
    write_tables({"mean_load": table}, snakemake.output)
