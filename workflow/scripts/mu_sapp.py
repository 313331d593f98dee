from maegawa2010.paper.definitions import definitions_table
from maegawa2010.paper.scene_numbers import measures_table, reproduction_table
from maegawa2010.support.job import job, read_all, write_tables
from precursors.solver.run import Run
from precursors.support.files import read_table

with job() as snakemake:
    params = snakemake.params
    runs = read_all(Run.load, snakemake.input.runs)
    slips = {
        name.removesuffix("_slips"): table
        for name, table in read_all(read_table, snakemake.input.slips).items()
    }
    tables = {
        "reproduction": reproduction_table(slips, params.paper),
        "measures": measures_table(runs),
        "definitions": definitions_table(
            list(runs.values()),
            params.slider,
            params.duration,
            params.settings["theta"],
            params.settings["load_drop"],
            [params.paper[scene] for scene in runs],
        ),
    }
    write_tables(tables, snakemake.output)
