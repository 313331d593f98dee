"""Run a chunk of the chains with a length until they settle."""

from job import job
from run_chunk import run_chunk

from maegawa2010.studies.larger.cycles import run_settled, settled_study

with job() as snakemake:
    params = snakemake.params
    study = settled_study(params.slider, params.settings)
    chunk = snakemake.wildcards.chunk
    run_chunk(study, chunk, snakemake.output.chunk, run_settled)
