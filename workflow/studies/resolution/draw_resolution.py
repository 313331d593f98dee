from maegawa2010.studies.resolution.figure import draw
from maegawa2010.support.drawing import save
from maegawa2010.support.job import job, read
from precursors.support.files import read_table

with job() as snakemake:
    table = read(read_table, snakemake.input.table)
    figure = draw(table, snakemake.params.papers_n, snakemake.params.mu_k)
    title = "events and mu_sapp against the number of blocks"
    save(figure, snakemake.output, title)
