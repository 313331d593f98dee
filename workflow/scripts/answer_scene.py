"""Ask a smaller model about a scene that names it."""

from job import job, write_tables

from maegawa2010.studies.models.models import scene_answers

with job() as snakemake:
    params = snakemake.params
    answers = scene_answers(params.slider, params.model)
    write_tables({"answers": answers}, snakemake.output)
