"""Draw the ladder of models: which one answers which question, and at what cost."""

from collections.abc import Sequence
from pathlib import Path

from job import job

from precursors.figures import style
from precursors.figures.ladder import draw_ladder, read_ladder


def main(ladder: str | Path, outputs: Sequence[str | Path]) -> None:
    """Draw the table of the ladder, once for each file name."""
    figure = draw_ladder(read_ladder(ladder))
    for output in outputs:
        style.save(figure, output)


if __name__ == "__main__":
    with job() as snakemake:
        main(snakemake.input.ladder, snakemake.output)
