"""Gather the chunks of a study in one table."""

from collections.abc import Sequence
from pathlib import Path

from job import job

from precursors.ensembles.study import gather
from precursors.support.files import write_table


def main(chunks: Sequence[str | Path], output: str | Path) -> None:
    """Write one row per member of a study: what it is, and what its run gave."""
    write_table(gather(chunks), output)


if __name__ == "__main__":
    with job() as snakemake:
        main(snakemake.input.chunks, snakemake.output.table)
