from maegawa2010.studies.step_sweep.tables import step_sweep_table
from maegawa2010.support.job import job, read_all, write_tables
from precursors.solver.run import Run

with job() as snakemake:
    runs = read_all(Run.load, snakemake.input.runs)
    table = step_sweep_table(runs, snakemake.params.full)
    write_tables({"step_sweep": table}, snakemake.output)
