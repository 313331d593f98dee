"""Tabulate what the certificates prove, and what their proofs took."""

from collections.abc import Mapping
from pathlib import Path

import pandas as pd
from job import job

from precursors.accuracy.proof import Certificate
from precursors.accuracy.proof.chains import certificate_row
from precursors.support.files import read_table, write_table


def main(certificates: Mapping[str, str | Path], effort: str | Path, output: str | Path) -> None:
    """Write one row a chain; the CPU time is that of the machine the committed certificate was made on."""
    rows = [{"chain": name, **certificate_row(Certificate.load(path))} for name, path in certificates.items()]
    write_table(pd.DataFrame(rows).merge(read_table(effort), on=["chain", "transitions"], how="left"), output)


if __name__ == "__main__":
    with job() as snakemake:
        main(
            dict(zip(snakemake.params.chains, snakemake.input.certificates, strict=True)),
            snakemake.input.effort,
            snakemake.output.table,
        )
