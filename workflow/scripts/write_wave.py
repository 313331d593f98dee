"""Write the animated picture of two precursors and the global slip, from a run."""

from job import job

from precursors.figures import wave
from precursors.solver.run import Run
from precursors.support.files import read_table

with job() as snakemake:
    run = Run.load(snakemake.input.run)
    slips = read_table(snakemake.input.slips)
    wave.draw(run, slips).savefig(snakemake.output[0])
