"""Draw what the step of RK4 does to the numbers that the paper prints."""

from collections.abc import Sequence
from pathlib import Path

from job import job

from precursors.figures import style
from precursors.figures.step_sweep import draw_step_sweep, read_step_sweep


def main(table: str | Path, outputs: Sequence[str | Path]) -> None:
    """Draw a table of step sweeps, once for each file name."""
    figure = draw_step_sweep(read_step_sweep(table))
    for output in outputs:
        style.save(figure, output)


if __name__ == "__main__":
    with job() as snakemake:
        main(snakemake.input.table, snakemake.output)
