"""Draw what the number of blocks does to chains with viscosity and interface springs."""

from collections.abc import Sequence
from pathlib import Path

from job import job

from precursors.figures import style
from precursors.figures.resolution_models import COLUMNS, RUN_COLUMNS, draw_resolution_models


def main(table: str | Path, runs: str | Path, papers_n: int, outputs: Sequence[str | Path]) -> None:
    """Draw the figure, once for each file name."""
    tables = style.read_columns(table, COLUMNS), style.read_columns(runs, RUN_COLUMNS)
    figure = draw_resolution_models(*tables, papers_n)
    for output in outputs:
        style.save(figure, output)


if __name__ == "__main__":
    with job() as snakemake:
        main(snakemake.input.table, snakemake.input.runs, snakemake.params.papers_n, snakemake.output)
