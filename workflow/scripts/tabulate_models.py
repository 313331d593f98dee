"""Ask every model every question."""

from job import job, write_tables

from maegawa2010.studies.models.tables import compare_models

with job() as snakemake:
    table = compare_models(snakemake.params.sliders)
    write_tables({"model_comparison": table}, snakemake.output)
