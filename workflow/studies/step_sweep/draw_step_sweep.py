from maegawa2010.studies.step_sweep.figure import draw
from maegawa2010.support.drawing import save
from maegawa2010.support.job import job, read
from precursors.support.files import read_table

with job() as snakemake:
    figure = draw(read(read_table, snakemake.input.table))
    title = "right counts and transitions against the step of a Runge-Kutta method"
    save(figure, snakemake.output, title)
