"""Run a chunk of the grid of chains."""

from job import job
from run_chunk import run_chunk

from maegawa2010.studies.grid.tables import grid_study

with job() as snakemake:
    params = snakemake.params
    study = grid_study(params.slider, params.axes)
    run_chunk(study, snakemake.wildcards.chunk, snakemake.output.chunk)
