"""Draw what the number of blocks does to the paper's numbers."""

import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from job import job

from precursors.ensembles.resolution import estimated_mu_sapp
from precursors.figures import style
from precursors.figures.resolution import COLUMNS, LIMIT_COLUMNS, draw_resolution


def main(
    table: str | Path, limits: str | Path, slider: Mapping[str, Any], outputs: Sequence[str | Path]
) -> None:
    """Draw the figure, once for each file name."""
    resolution = style.read_columns(table, COLUMNS)
    n_blocks = sorted(set(resolution["n_blocks"]))
    estimate = estimated_mu_sapp(n_blocks, slider["mu_s"], slider["mu_k"])
    area, mass = slider["cross_section"], slider["slider_mass"]
    wave_speed = math.sqrt(slider["youngs_modulus"] * area * slider["length"] / mass)
    figure = draw_resolution(
        resolution,
        style.read_columns(limits, LIMIT_COLUMNS),
        dict(zip(n_blocks, estimate.tolist(), strict=True)),
        wave_speed,
    )
    for output in outputs:
        style.save(figure, output)


if __name__ == "__main__":
    with job() as snakemake:
        main(snakemake.input.table, snakemake.input.limits, snakemake.params.slider, snakemake.output)
