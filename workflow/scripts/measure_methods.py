"""Time the methods on some chains and compare their runs with what is proved."""

from collections.abc import Mapping
from pathlib import Path

from job import job  # before NumPy: it sets the number of threads

# isort: split
import pandas as pd

from precursors.accuracy.proof import Certificate
from precursors.accuracy.work_precision import (
    LONGEST,
    LONGEST_FULL,
    ROUNDS,
    ROUNDS_FULL,
    charted_values,
    measure_methods,
    proved_cases,
)
from precursors.support.files import write_table


def main(
    certificates: Mapping[str, str | Path],
    thetas: Mapping[str, float],
    full: bool,
    output: str | Path,
) -> None:
    """Write one row per chain, extent, method and value of its setting."""
    rounds, longest = (ROUNDS_FULL, LONGEST_FULL) if full else (ROUNDS, LONGEST)
    tables = [
        measure_methods(case, charted_values(case, full), rounds, longest)
        for chain, path in certificates.items()
        for case in proved_cases(chain, thetas[chain], Certificate.load(path))
    ]
    write_table(pd.concat(tables, ignore_index=True), output)


if __name__ == "__main__":
    with job() as snakemake:
        main(
            dict(zip(snakemake.params.thetas, snakemake.input.certificates, strict=True)),
            snakemake.params.thetas,
            snakemake.params.full,
            snakemake.output.table,
        )
