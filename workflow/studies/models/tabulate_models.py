from maegawa2010.studies.models.tables import compare_models
from maegawa2010.support.job import job, write_tables

with job() as snakemake:
    table = compare_models(snakemake.params.sliders)
    write_tables({"model_comparison": table}, snakemake.output)
