from maegawa2010.studies.resolution.tables import (
    resolution_study,
    resolution_tables,
    with_first,
)
from maegawa2010.support.job import job, read, read_all, write_tables
from precursors.support.files import read_table

with job() as snakemake:
    params = snakemake.params
    chunks = read_all(read_table, snakemake.input.chunks)
    noise = read(read_table, snakemake.input.noise)
    tables = resolution_tables(chunks.values(), noise)
    if params.full:
        study = resolution_study(params.sliders, params.duration, params.settings)
        tables["resolution"] = with_first(tables["resolution"], study)
    write_tables(tables, snakemake.output)
