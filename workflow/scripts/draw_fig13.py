"""Draw Fig. 13: the propagation length of the precursors against the tangential load."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from job import job

from precursors.figures import style
from precursors.figures.precursor_lengths import PrecursorLengths, draw_precursor_lengths


def main(
    slips: Sequence[str | Path], sliders: Sequence[dict[str, Any]], outputs: Sequence[str | Path]
) -> None:
    """Draw the slip tables of several scenes in one figure, once for each file name."""
    scenes = [
        PrecursorLengths(style.read_slips(path), slider["theta"], slider["n_blocks"], slider["normal_load"])
        for path, slider in zip(slips, sliders, strict=True)
    ]
    figure = draw_precursor_lengths(scenes)
    for output in outputs:
        style.save(figure, output)


if __name__ == "__main__":
    with job() as snakemake:
        main(snakemake.input.slips, snakemake.params.sliders, snakemake.output)
