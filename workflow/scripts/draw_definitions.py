"""Draw what every reading of the paper's words gives."""

from collections.abc import Sequence
from pathlib import Path

from job import job

from precursors.figures import style
from precursors.figures.definitions import draw_definitions
from precursors.support.files import read_table


def main(table: str | Path, outputs: Sequence[str | Path]) -> None:
    """Draw the table of definitions, once for each file name."""
    figure = draw_definitions(read_table(table))
    for output in outputs:
        style.save(figure, output)


if __name__ == "__main__":
    with job() as snakemake:
        main(snakemake.input.table, snakemake.output)
