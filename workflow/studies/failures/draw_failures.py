from maegawa2010.studies.failures.figure import draw
from maegawa2010.support.drawing import save
from maegawa2010.support.job import job, read
from precursors.support.files import read_table

with job() as snakemake:
    curves = read(read_table, snakemake.input.curves)
    figure = draw(curves, read_table(snakemake.input.panels))
    save(figure, snakemake.output, "six ways in which methods fail")
