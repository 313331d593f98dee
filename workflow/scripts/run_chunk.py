"""Run one chunk of a study: every n-th member."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from job import job

from precursors.ensembles.catalogue import STUDIES
from precursors.ensembles.study import run_members
from precursors.support.files import write_table


def main(name: str, arguments: Mapping[str, Any], chunk: str, output: str | Path) -> None:
    """Write one row per member of a chunk, "1of4" to "4of4": what it is, and what its run gave."""
    number, chunks = map(int, chunk.split("of"))
    found = run_members(STUDIES[name](**arguments).chunk(number - 1, chunks))
    write_table(found.rename_axis("member").reset_index(), output)


if __name__ == "__main__":
    with job() as snakemake:
        main(
            snakemake.wildcards.study,
            snakemake.params.arguments,
            snakemake.wildcards.chunk,
            snakemake.output.chunk,
        )
