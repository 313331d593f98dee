"""Gather the runs of the grid, and draw mu_sapp over two values of the chain."""

from drawing import save
from job import job, read_all

from maegawa2010.studies.grid.figure import draw
from maegawa2010.studies.members import gather
from precursors.support.files import read_table, write_table

with job() as snakemake:
    params = snakemake.params
    chunks = read_all(read_table, snakemake.input.chunks)
    table = gather(chunks.values())
    write_table(table, snakemake.output.table)
    keys = " and ".join(axis["key"] for axis in params.axes)
    figure = draw(table, params.axes, params.scenes)
    save(figure, snakemake.output.figures, f"mu_sapp over {keys}")
