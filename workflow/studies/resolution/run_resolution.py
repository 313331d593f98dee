from maegawa2010.studies.resolution.tables import resolution_study
from maegawa2010.studies.runs import run_chunk
from maegawa2010.support.job import job

with job() as snakemake:
    params = snakemake.params
    study = resolution_study(params.sliders, params.duration, params.settings)
    run_chunk(study, snakemake.wildcards.chunk, snakemake.output.members)
