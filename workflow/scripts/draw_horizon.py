"""Draw how far the digits of a run hold, and the Lyapunov exponents."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from job import job

from precursors.figures import style
from precursors.figures.horizon import draw_horizon


def main(
    tables: Sequence[str | Path],
    chains: Mapping[str, Mapping[str, Any]],
    tolerance: float,
    outputs: Sequence[str | Path],
) -> None:
    """Draw the tables horizon, solver_vs_proof and lyapunov in one figure, once for each file name."""
    errors, overview, exponents = (style.read_columns(path, {}) for path in tables)
    figure = draw_horizon(errors, overview, exponents, chains, tolerance)
    for output in outputs:
        style.save(figure, output)


if __name__ == "__main__":
    with job() as snakemake:
        main(
            [snakemake.input.horizon, snakemake.input.summary, snakemake.input.lyapunov],
            snakemake.params.chains,
            snakemake.params.tolerance,
            snakemake.output,
        )
