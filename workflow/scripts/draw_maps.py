"""Draw the maps over theta and one parameter more."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from job import job

from precursors.figures import style
from precursors.figures.maps import draw_map, read_map


def main(
    tables: Mapping[str, str | Path], sliders: Sequence[Mapping[str, Any]], outputs: Sequence[str | Path]
) -> None:
    """Draw the map of each table into the files that have its name; crosses are the sliders of scenes."""
    for name, table in tables.items():
        figure = draw_map(read_map(table, name), name, sliders)
        for output in outputs:
            if Path(output).stem == name:
                style.save(figure, output)


if __name__ == "__main__":
    with job() as snakemake:
        main(
            dict(zip(snakemake.params.maps, snakemake.input.tables, strict=True)),
            snakemake.params.sliders,
            snakemake.output,
        )
