"""Score the lists of transitions of other solvers."""

from pathlib import Path

from job import job, read, write_tables

from maegawa2010.studies.benchmark.tables import score_table
from precursors.support.files import read_table

with job() as snakemake:
    solvers = read(read_table, snakemake.input.solvers)
    folder = str(Path(snakemake.input.solvers).with_name("results"))
    table = score_table(solvers, folder)
    write_tables({"benchmark": table}, snakemake.output)
