"""Tabulate what other readings of the paper's words give, one change at a time."""

from job import job

from precursors.reproduction.definitions import definitions_table
from precursors.solver.run import Run
from precursors.support.files import write_table

if __name__ == "__main__":
    with job() as snakemake:
        options = {name: value for name, value in snakemake.params.items() if name != "code"}
        runs = [Run.load(path) for path in snakemake.input.runs]
        write_table(definitions_table(runs, **options), snakemake.output.table)
