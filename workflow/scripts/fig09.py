from maegawa2010.paper.chain_schematic import draw
from maegawa2010.support.drawing import save
from maegawa2010.support.job import job

with job() as snakemake:
    title = "the model: blocks on springs, pushed through a spring"
    save(draw(), snakemake.output, title)
