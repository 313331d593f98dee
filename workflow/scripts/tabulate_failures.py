"""Make every method fail."""

from job import job, write_tables

from maegawa2010.studies.failures.tables import failure_curves

with job() as snakemake:
    write_tables({"failure_curves": failure_curves()}, snakemake.output)
