"""Draw the push along the row before and after three slips."""

from drawing import save
from job import job, read

from precursors.figures import push, style
from precursors.solver.run import Run
from precursors.support.files import read_table

with job() as snakemake:
    look = style.Look(**snakemake.params.look)
    run = read(Run.load, snakemake.input.run)
    slips = read(read_table, snakemake.input.slips)
    figure = push.draw(run, slips, look=look)
    save(figure, snakemake.output, "why a slip stops where it does", look)
