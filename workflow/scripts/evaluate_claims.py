"""Compare what the paper states with the tables, and write the verdicts."""

from pathlib import Path

from job import job

from precursors.reproduction.claims import evaluate
from precursors.reproduction.tables import Tables
from precursors.support.files import write_table


def main(tables: str | Path, output: str | Path) -> None:
    """Write one row per claim, with its verdict by the tables of a directory."""
    write_table(evaluate(Tables(tables)), output)


if __name__ == "__main__":
    with job() as snakemake:
        main(Path(snakemake.output.table).parent, snakemake.output.table)
