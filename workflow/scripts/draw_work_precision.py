"""Draw the errors of all methods against time, and against evaluations of the forces."""

from collections.abc import Sequence
from pathlib import Path

from job import job

from precursors.figures import style
from precursors.figures.work_precision import Work, draw_work_precision, read_work_precision


def main(
    table: str | Path, time_outputs: Sequence[str | Path], evaluations_outputs: Sequence[str | Path]
) -> None:
    """Draw the two charts of a table, each once for each file name."""
    rows = read_work_precision(table)
    for work, outputs in ((Work.TIME, time_outputs), (Work.EVALUATIONS, evaluations_outputs)):
        figure = draw_work_precision(rows, work)
        for output in outputs:
            style.save(figure, output)


if __name__ == "__main__":
    with job() as snakemake:
        output = snakemake.output
        main(
            snakemake.input.table,
            [output.time_png, output.time_svg],
            [output.evaluations_png, output.evaluations_svg],
        )
