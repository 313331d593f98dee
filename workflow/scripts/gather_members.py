"""Gather the chunks of a study in one table."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from job import job

from precursors.ensembles.catalogue import make_study
from precursors.ensembles.chunks import gather
from precursors.support.files import write_table


def main(config: Mapping[str, Any], name: str, chunks: Sequence[str | Path], output: str | Path) -> None:
    """Write one row per member of a study: what it is, and what it gave."""
    write_table(gather(make_study(config, name), chunks), output)


if __name__ == "__main__":
    with job() as snakemake:
        main(snakemake.config, snakemake.wildcards.study, snakemake.input.chunks, snakemake.output.table)
