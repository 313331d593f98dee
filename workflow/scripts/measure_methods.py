"""Time the methods on some chains and compare their runs with what is proved."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from job import job  # before NumPy: it sets the number of threads

# isort: split
import pandas as pd

from precursors.accuracy.proof import Certificate
from precursors.accuracy.work_precision import measure_methods, proved_cases, sweeps_of
from precursors.support.files import write_table


def main(
    certificates: Mapping[str, str | Path],
    thetas: Mapping[str, float],
    size: Mapping[str, Any],
    output: str | Path,
) -> None:
    """Write one row per chain, extent, method and value of its knob; `size` is as in the configuration."""
    sweeps = [sweeps_of(size[extent]) for extent in ("first_slip", "whole_run")]
    tables = [
        measure_methods(case, values, size["repetitions"], size["longest"])
        for chain, path in certificates.items()
        for case, values in zip(
            proved_cases(chain, thetas[chain], Certificate.load(path)), sweeps, strict=True
        )
    ]
    write_table(pd.concat(tables, ignore_index=True), output)


if __name__ == "__main__":
    with job() as snakemake:
        main(
            dict(zip(snakemake.params.thetas, snakemake.input.certificates, strict=True)),
            snakemake.params.thetas,
            snakemake.params.size,
            snakemake.output.table,
        )
