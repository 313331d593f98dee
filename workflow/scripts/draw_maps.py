"""Draw the maps over theta and one parameter more."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from job import job

from precursors.figures import style
from precursors.figures.maps import draw_map, read_map


def main(
    table: str | Path, name: str, sliders: Sequence[Mapping[str, Any]], outputs: Sequence[str | Path]
) -> None:
    """Draw the map of this name; crosses are the sliders of scenes."""
    figure = draw_map(read_map(table, name), name, sliders)
    for output in outputs:
        style.save(figure, output)


if __name__ == "__main__":
    with job() as snakemake:
        main(snakemake.input.table, snakemake.wildcards.map, snakemake.params.sliders, snakemake.output)
