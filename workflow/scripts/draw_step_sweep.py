"""Run the scenes with Runge-Kutta steps of many sizes, and draw what is right."""

from drawing import save
from job import job, read_all

from maegawa2010.studies.step_sweep.figure import draw
from maegawa2010.studies.step_sweep.tables import step_sweep_table
from precursors.solver.run import Run
from precursors.support.files import read_table, write_table

with job() as snakemake:
    runs = read_all(Run.load, snakemake.input.runs)
    output = snakemake.output
    write_table(step_sweep_table(runs, snakemake.params.full), output.table)
    title = (
        "counts and transitions that are right against the step of a Runge-Kutta method"
    )
    save(draw(read_table(output.table)), output.figures, title)
