"""Draw events and mu_sapp against the number of blocks."""

from drawing import save
from job import job, read

from maegawa2010.studies.resolution.figure import draw
from precursors.support.files import read_table

with job() as snakemake:
    table = read(read_table, snakemake.input.table)
    finer = [read_table(path) for path in snakemake.input.finer]
    figure = draw(table, snakemake.params.papers_n, snakemake.params.mu_k, *finer)
    title = "events and mu_sapp against the number of blocks"
    save(figure, snakemake.output, title)
