"""Draw how errors grow."""

from drawing import save
from job import job, read

from maegawa2010.studies.horizon.figure import draw
from precursors.support.files import read_table

with job() as snakemake:
    errors = read(read_table, snakemake.input.errors)
    params = snakemake.params
    figure = draw(errors, params.thetas, params.tolerance)
    save(figure, snakemake.output, "how errors grow, predicted and actual")
