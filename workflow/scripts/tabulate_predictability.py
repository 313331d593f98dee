"""Tabulate the predictability time of chains of more and more blocks."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from job import job

from precursors.ensembles.resolution import predictability_table
from precursors.support.files import write_table


def main(
    sliders: Mapping[str, Mapping[str, Any]],
    n_blocks: Sequence[int],
    duration: float,
    tolerance: float,
    output: str | Path,
) -> None:
    """Write a row per scene and number of blocks: until when the run without noise is right."""
    write_table(predictability_table(sliders, n_blocks, duration, tolerance), output)


if __name__ == "__main__":
    with job() as snakemake:
        params = snakemake.params
        main(params.sliders, params.n_blocks, params.duration, params.tolerance, snakemake.output.table)
