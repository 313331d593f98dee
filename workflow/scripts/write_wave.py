"""Write the looping picture of a global slip, from a run."""

from job import job

from precursors.figures import wave
from precursors.solver.run import Run
from precursors.support.files import read_table, write_text

with job() as snakemake:
    run = Run.load(snakemake.input.run)
    slips = read_table(snakemake.input.slips)
    write_text(snakemake.output[0], wave.draw(run, slips))
