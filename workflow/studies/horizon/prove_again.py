from pathlib import Path
from time import process_time

import pandas as pd

from maegawa2010.studies.horizon.chains import certificate_row
from maegawa2010.support.job import job
from precursors.proof import verify
from precursors.support.files import write_table

with job() as snakemake:
    start = process_time()
    proved = certificate_row(verify(snakemake.input.certificate))
    chain = Path(snakemake.input.certificate).name.removesuffix(".json.gz")
    row = {"chain": chain, **proved, "cpu_s": round(process_time() - start, 1)}
    write_table(pd.DataFrame([row]), snakemake.output.table)
