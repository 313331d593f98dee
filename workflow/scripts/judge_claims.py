"""Judge what the paper states by the tables, and write the ledger."""

from collections.abc import Sequence
from pathlib import Path

from job import job

from precursors.reproduction.ledger.claims import read_claims
from precursors.reproduction.ledger.judge import judge, to_table
from precursors.support.files import write_table


def main(claims: str | Path, tables: Sequence[str | Path], output: str | Path) -> None:
    """Write one row per claim with its verdict, judged by these of the tables beside the output."""
    names = [Path(table).stem for table in tables]
    write_table(to_table(judge(read_claims(claims), Path(output).parent, names)), output)


if __name__ == "__main__":
    with job() as snakemake:
        main(snakemake.input.claims, snakemake.input.tables, snakemake.output.table)
