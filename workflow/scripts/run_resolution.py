"""Run a chunk of the chains with other numbers of blocks."""

from job import job
from run_chunk import run_chunk

from maegawa2010.studies.resolution.tables import resolution_study

with job() as snakemake:
    params = snakemake.params
    study = resolution_study(params.sliders, params.duration, params.settings)
    run_chunk(study, snakemake.wildcards.chunk, snakemake.output.chunk)
