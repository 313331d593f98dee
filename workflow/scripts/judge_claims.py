from maegawa2010.paper.claims import evaluate
from maegawa2010.paper.open_points import open_points_table
from maegawa2010.support.job import job, read_all, write_tables
from precursors.support.files import read_table

with job() as snakemake:
    inputs = snakemake.input
    tables = read_all(read_table, [*inputs.tables, *inputs.checks])
    judged = {"claims": evaluate(tables), "open_points": open_points_table(tables)}
    write_tables(judged, snakemake.output)
