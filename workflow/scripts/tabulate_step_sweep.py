"""Tabulate what the step of RK4 does to the numbers that the paper prints."""

from collections.abc import Mapping
from pathlib import Path

import pandas as pd
from job import job

from precursors.accuracy.step_sweep import charted_steps, sweep
from precursors.solver.run import Run
from precursors.support.files import write_table


def main(runs: Mapping[str, str | Path], thetas: Mapping[str, float], full: bool, output: str | Path) -> None:
    """Write one row per scene, method and step; the exact solver's has no step."""
    rows = [
        {"scene": scene, "theta": thetas[scene], **row}
        for scene, path in runs.items()
        for row in sweep(Run.load(path), charted_steps(full))
    ]
    write_table(pd.DataFrame(rows), output)


if __name__ == "__main__":
    with job() as snakemake:
        main(
            dict(zip(snakemake.params.thetas, snakemake.input.runs, strict=True)),
            snakemake.params.thetas,
            snakemake.params.full,
            snakemake.output.table,
        )
