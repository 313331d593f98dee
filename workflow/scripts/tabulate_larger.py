"""Run chains with a length to their first global slip."""

from job import job, write_tables

from maegawa2010.studies.larger.first_slips import larger_tables

with job() as snakemake:
    params = snakemake.params
    write_tables(larger_tables(params.slider, params.settings), snakemake.output)
