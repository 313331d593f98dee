"""Tabulate what every reading of "global slip", "short", "front" and theta gives beside the paper."""

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

from job import job

from precursors.reproduction.definitions import definitions_table
from precursors.support.files import write_table


def main(
    slider: Mapping[str, Any],
    duration: float,
    degrees: Sequence[float | str],
    load_drops: Iterable[float],
    paper: Sequence[Mapping[str, float]],
    output: str | Path,
) -> None:
    """Write one row per size of theta, sign of it and reading."""
    write_table(definitions_table(slider, duration, degrees, load_drops, paper), output)


if __name__ == "__main__":
    with job() as snakemake:
        main(
            snakemake.params.slider,
            snakemake.params.duration,
            snakemake.params.degrees,
            snakemake.params.load_drops,
            snakemake.params.paper,
            snakemake.output.table,
        )
