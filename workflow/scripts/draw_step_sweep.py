"""Draw the transitions that are right against the step of a Runge-Kutta method."""

from drawing import save
from job import job, read

from maegawa2010.studies.step_sweep.figure import draw
from precursors.support.files import read_table

with job() as snakemake:
    figure = draw(read(read_table, snakemake.input.table))
    title = (
        "counts and transitions that are right against the step of a Runge-Kutta method"
    )
    save(figure, snakemake.output, title)
