"""Draw what the number of blocks does to the paper's numbers."""

from collections.abc import Sequence
from pathlib import Path

from job import job

from precursors.figures import style
from precursors.figures.resolution import COLUMNS, LIMIT_COLUMNS, draw_resolution


def main(table: str | Path, limits: str | Path, papers_n: int, outputs: Sequence[str | Path]) -> None:
    """Draw the figure, once for each file name."""
    figure = draw_resolution(
        style.read_columns(table, COLUMNS), style.read_columns(limits, LIMIT_COLUMNS), papers_n
    )
    for output in outputs:
        style.save(figure, output)


if __name__ == "__main__":
    with job() as snakemake:
        main(snakemake.input.table, snakemake.input.limits, snakemake.params.papers_n, snakemake.output)
