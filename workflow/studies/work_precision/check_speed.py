from pathlib import Path

from maegawa2010.paper.committed import hand_on
from maegawa2010.studies.work_precision.tables import check
from maegawa2010.support.job import job, read
from precursors.support.files import read_table

with job() as snakemake:
    inputs = snakemake.input
    tables = {Path(path).stem: read_table(path) for path in inputs.tables}
    comparison = check(tables, read(read_table, inputs.measured))
    hand_on(comparison, inputs.tables, inputs.provenance, snakemake.output)
