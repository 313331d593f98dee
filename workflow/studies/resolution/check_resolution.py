from pathlib import Path

from maegawa2010.paper.committed import hand_on
from maegawa2010.studies.resolution.tables import check, resolution_study
from maegawa2010.support.job import job, read_all
from precursors.support.files import read_table

with job() as snakemake:
    inputs, params = snakemake.input, snakemake.params
    tables = {Path(path).stem: read_table(path) for path in inputs.tables}
    noise = read_all(read_table, inputs.noise)
    study = resolution_study(params.sliders, params.duration, params.settings)
    comparison = check(tables, study, noise)
    hand_on(comparison, inputs.tables, inputs.provenance, snakemake.output)
