from maegawa2010.support.drawing import save
from maegawa2010.support.job import job, read
from precursors.figures import push, style, wave
from precursors.solver.run import Run
from precursors.support.files import read_table

with job() as snakemake:
    look = style.Look(**snakemake.params.look)
    run = read(Run.load, snakemake.input.run)
    slips = read(read_table, snakemake.input.slips)
    figures = [snakemake.output.push, *snakemake.output.more]
    title = "what a slip adds to the push and releases"
    save(push.draw(run, slips, look=look), figures, title, look)
    wave.draw(run, slips).savefig(snakemake.output.wave)
