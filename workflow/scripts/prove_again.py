"""Make the proof of a certificate again, and write what it took."""

from pathlib import Path
from time import process_time

import pandas as pd
from job import job

from precursors.accuracy.proof import verify
from precursors.accuracy.proof.chains import certificate_row
from precursors.support.files import write_table


def main(certificate: str | Path, output: str | Path) -> None:
    """Prove every transition of a certificate again; an altered one is refused."""
    start = process_time()
    proved = verify(certificate)
    row = {"chain": Path(certificate).name.removesuffix(".json.gz"), **certificate_row(proved)}
    write_table(pd.DataFrame([{**row, "cpu_s": round(process_time() - start, 1)}]), output)


if __name__ == "__main__":
    with job() as snakemake:
        main(snakemake.input.certificate, snakemake.output.table)
