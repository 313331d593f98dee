"""Draw the time per transition against the number of blocks."""

from collections.abc import Sequence
from pathlib import Path

from job import job

from precursors.figures import style
from precursors.figures.growth import draw_growth, read_growth


def main(table: str | Path, outputs: Sequence[str | Path]) -> None:
    """Draw a table, once for each file name."""
    figure = draw_growth(read_growth(table))
    for output in outputs:
        style.save(figure, output)


if __name__ == "__main__":
    with job() as snakemake:
        main(snakemake.input.table, snakemake.output)
