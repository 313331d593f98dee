"""Compare what the paper states with the tables, and write the verdicts, misprints and open points."""

from pathlib import Path

from job import job

from precursors.reproduction.claims import evaluate
from precursors.reproduction.open_points import open_points_table
from precursors.reproduction.tables import Tables
from precursors.support.files import write_table

if __name__ == "__main__":
    with job() as snakemake:
        tables = Tables(Path(snakemake.output.claims).parent)
        write_table(evaluate(tables), snakemake.output.claims)
        write_table(open_points_table(tables), snakemake.output.open_points)
