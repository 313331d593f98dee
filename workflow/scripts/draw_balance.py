"""Draw the mean of F_X under three loadings."""

from drawing import save
from job import job, read

from maegawa2010.studies.balance.figure import draw
from precursors.support.files import read_table

with job() as snakemake:
    table = read(read_table, snakemake.input.table)
    curves = read(read_table, snakemake.input.curves)
    title = "the mean load is the kinetic friction, whatever the loading"
    save(draw(table, curves), snakemake.output, title)
