"""Draw the failure gallery."""

from collections.abc import Mapping, Sequence
from pathlib import Path

from job import job

from precursors.figures import style
from precursors.figures.failure_gallery import PANELS, draw_failure_gallery, read_numbers
from precursors.support.files import read_table


def main(numbers: str | Path, curves: Mapping[str, str | Path], outputs: Sequence[str | Path]) -> None:
    """Draw the numbers and the curves of all ways to fail, once for each file name."""
    figure = draw_failure_gallery(
        read_numbers(numbers), {way: read_table(path) for way, path in curves.items()}
    )
    for output in outputs:
        style.save(figure, output)


if __name__ == "__main__":
    with job() as snakemake:
        main(
            snakemake.input.numbers,
            dict(zip(PANELS, snakemake.input.curves, strict=True)),
            snakemake.output,
        )
