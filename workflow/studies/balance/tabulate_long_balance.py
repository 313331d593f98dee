from maegawa2010.studies.balance.long import (
    blocks_table,
    first_slips_table,
    loads_table,
    runs_table,
)
from maegawa2010.support.job import job, write_tables

with job() as snakemake:
    slider, sliders = snakemake.params.slider, snakemake.params.sliders
    settings = snakemake.params.settings
    seed = settings["seed"]
    tables = {
        "balance_first_slips": first_slips_table(
            sliders, settings["first_slips"], seed
        ),
        "balance_blocks": blocks_table(slider, settings["blocks_seconds"]),
        "balance_loads": loads_table(slider, settings["loads"], seed),
        "balance_runs": runs_table(slider, settings["runs"], seed),
    }
    write_tables(tables, snakemake.output)
