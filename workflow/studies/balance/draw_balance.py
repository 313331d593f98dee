from maegawa2010.studies.balance.figure import draw
from maegawa2010.support.drawing import save
from maegawa2010.support.job import job, read
from precursors.support.files import read_table

with job() as snakemake:
    table = read(read_table, snakemake.input.table)
    curves = read(read_table, snakemake.input.curves)
    title = "the mean load is the kinetic friction, whatever the loading"
    save(draw(table, curves), snakemake.output, title)
