from pathlib import Path

from maegawa2010.paper.committed import hand_on
from maegawa2010.studies.balance.long import check
from maegawa2010.support.job import job
from precursors.support.files import read_table

with job() as snakemake:
    inputs, params = snakemake.input, snakemake.params
    tables = {Path(path).stem: read_table(path) for path in inputs.tables}
    comparison = check(tables, params.slider, params.sliders, params.settings)
    hand_on(comparison, inputs.tables, inputs.provenance, snakemake.output)
