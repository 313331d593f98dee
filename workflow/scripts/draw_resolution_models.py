"""Draw what the number of blocks does to chains with viscosity and interface springs."""

from collections.abc import Sequence
from pathlib import Path

from job import job

from precursors.figures import style
from precursors.figures.resolution_models import COLUMNS, draw_resolution_models


def main(table: str | Path, outputs: Sequence[str | Path]) -> None:
    """Draw the figure, once for each file name."""
    figure = draw_resolution_models(style.read_columns(table, COLUMNS))
    for output in outputs:
        style.save(figure, output)


if __name__ == "__main__":
    with job() as snakemake:
        main(snakemake.input.table, snakemake.output)
