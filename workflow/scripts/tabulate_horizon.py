"""Compare the solver, and the errors it predicts, with the proof."""

from collections.abc import Mapping
from pathlib import Path

import pandas as pd
from job import job

from precursors.accuracy.proof import Certificate
from precursors.accuracy.solver_vs_proof import error_table, summary, validate
from precursors.support.files import write_table


def main(
    certificates: Mapping[str, str | Path], tolerance: float, horizon: str | Path, overview: str | Path
) -> None:
    """Write the errors over time, and one row a chain."""
    runs = {name: validate(Certificate.load(path)) for name, path in certificates.items()}
    errors = [error_table(run).assign(chain=name) for name, run in runs.items()]
    write_table(pd.concat(errors)[["chain", "time_s", "actual_error_s", "predicted_error_s"]], horizon)
    write_table(
        pd.DataFrame([{"chain": name, **summary(run, tolerance)} for name, run in runs.items()]), overview
    )


if __name__ == "__main__":
    with job() as snakemake:
        main(
            dict(zip(snakemake.params.chains, snakemake.input.certificates, strict=True)),
            snakemake.params.tolerance,
            snakemake.output.horizon,
            snakemake.output.summary,
        )
