"""Draw how far the digits of a run hold, and the Lyapunov exponents."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from job import job

from precursors.figures import style
from precursors.figures.horizon import ERROR_COLUMNS, EXPONENT_COLUMNS, OVERVIEW_COLUMNS, draw_horizon


def main(
    tables: Sequence[str | Path],
    chains: Mapping[str, Mapping[str, Any]],
    thetas: Mapping[str, float],
    tolerance: float,
    outputs: Sequence[str | Path],
) -> None:
    """Draw the tables horizon, solver_vs_proof and lyapunov in one figure, once for each file name."""
    needed = (ERROR_COLUMNS, OVERVIEW_COLUMNS, EXPONENT_COLUMNS)
    errors, overview, exponents = map(style.read_columns, tables, needed)
    figure = draw_horizon(errors, overview, exponents, chains, thetas, tolerance)
    for output in outputs:
        style.save(figure, output)


if __name__ == "__main__":
    with job() as snakemake:
        main(
            [snakemake.input.horizon, snakemake.input.summary, snakemake.input.lyapunov],
            snakemake.params.chains,
            snakemake.params.thetas,
            snakemake.params.tolerance,
            snakemake.output,
        )
