"""Make every method fail, and draw six ways of it."""

from drawing import save
from job import job

from maegawa2010.studies.failures.figure import draw
from maegawa2010.studies.failures.tables import failure_curves
from precursors.support.files import read_table, write_table

with job() as snakemake:
    output = snakemake.output
    write_table(failure_curves(), output.curves)
    figure = draw(read_table(output.curves), read_table(snakemake.input.panels))
    save(figure, output.figures, "six ways in which methods fail")
