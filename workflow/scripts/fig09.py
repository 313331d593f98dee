"""Draw the model (Fig. 9)."""

from drawing import save
from job import job

from maegawa2010.paper.chain_schematic import draw

with job() as snakemake:
    title = "the model: blocks on springs, pushed through a spring"
    save(draw(), snakemake.output, title)
