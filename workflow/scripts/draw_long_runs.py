"""Draw the distribution of the peak loads of hundreds of global slips."""

from collections.abc import Sequence
from pathlib import Path

from job import job

from precursors.figures import style
from precursors.figures.long_runs import COLUMNS, STATISTICS_COLUMNS, draw_long_runs


def main(slips: str | Path, statistics: str | Path, outputs: Sequence[str | Path]) -> None:
    """Draw the figure, once for each file name."""
    figure = draw_long_runs(
        style.read_columns(slips, COLUMNS), style.read_columns(statistics, STATISTICS_COLUMNS)
    )
    for output in outputs:
        style.save(figure, output)


if __name__ == "__main__":
    with job() as snakemake:
        main(snakemake.input.slips, snakemake.input.statistics, snakemake.output)
