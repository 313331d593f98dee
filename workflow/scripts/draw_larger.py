"""Draw a chain with a length, cut from the paper's slider."""

from drawing import save
from job import job

from maegawa2010.studies.larger.figure import draw
from precursors.support.files import read_table

with job() as snakemake:
    figure = draw(read_table(snakemake.input.settled))
    title = "the settled coefficient of chains with a length"
    save(figure, snakemake.output, title)
