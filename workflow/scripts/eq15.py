from maegawa2010.paper.eq15 import eq15_table
from maegawa2010.support.job import job, read_all, write_tables
from precursors.solver.run import Run

with job() as snakemake:
    runs = read_all(Run.load, snakemake.input.runs)
    table = eq15_table(runs, snakemake.params.duration)
    write_tables({"eq15": table}, snakemake.output)
