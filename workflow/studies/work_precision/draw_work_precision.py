from maegawa2010.studies.work_precision.figure import draw
from maegawa2010.support.drawing import save
from maegawa2010.support.job import job, read
from precursors.support.files import read_table

with job() as snakemake:
    measured = read(read_table, snakemake.input.measured)
    title = "what accuracy costs, measured by this build"
    save(draw(measured), snakemake.output.measured, title)
    for path in snakemake.input.published:
        published = draw(read_table(path), compared="heyoka")
        title = "what accuracy costs, as published for the paper's slider"
        save(published, snakemake.output.published, title)
