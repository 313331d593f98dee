from maegawa2010.studies.failures.tables import failure_curves
from maegawa2010.support.job import job, write_tables

with job() as snakemake:
    write_tables({"failure_curves": failure_curves()}, snakemake.output)
