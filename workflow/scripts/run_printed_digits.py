"""Run a chunk of the sliders with the same printed inputs."""

from job import job
from run_chunk import run_chunk

from maegawa2010.studies.printed_digits.tables import digits_study

with job() as snakemake:
    params = snakemake.params
    study = digits_study(params.sliders, params.duration, params.settings)
    run_chunk(study, snakemake.wildcards.chunk, snakemake.output.chunk)
