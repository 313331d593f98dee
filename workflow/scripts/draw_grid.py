"""Draw mu_sapp over two values of the chain."""

from drawing import save
from job import job, read

from maegawa2010.studies.grid.figure import draw
from precursors.support.files import read_table

with job() as snakemake:
    params = snakemake.params
    table = read(read_table, snakemake.input.table)
    keys = " and ".join(axis["key"] for axis in params.axes)
    figure = draw(table, params.axes, params.scenes)
    save(figure, snakemake.output, f"mu_sapp over {keys}")
