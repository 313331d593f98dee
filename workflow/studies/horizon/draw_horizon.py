from maegawa2010.studies.horizon.figure import draw
from maegawa2010.support.drawing import save
from maegawa2010.support.job import job, read
from precursors.support.files import read_table

with job() as snakemake:
    errors = read(read_table, snakemake.input.errors)
    params = snakemake.params
    figure = draw(errors, params.thetas, params.tolerance)
    save(figure, snakemake.output, "how errors grow, predicted and actual")
