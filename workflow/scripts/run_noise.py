"""Run a chunk of the chains with noise in the normal loads."""

from job import job
from run_chunk import run_chunk

from maegawa2010.studies.noise.tables import noise_study

with job() as snakemake:
    params = snakemake.params
    study = noise_study(params.sliders, params.duration, params.settings)
    run_chunk(study, snakemake.wildcards.chunk, snakemake.output.chunk)
