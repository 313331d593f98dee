"""Write the explorer: one HTML page that solves the chain in the browser."""

import pandas as pd

from maegawa2010.explorer.data import explorer_data
from maegawa2010.explorer.page import write_explorer
from maegawa2010.support.job import job

TABLES = ("members", "shares", "resolution")

with job() as snakemake:
    params = snakemake.params
    tables = {name: pd.read_csv(snakemake.input[name]) for name in TABLES}
    slips = map(pd.read_csv, snakemake.input.slips)
    data = explorer_data(params.sliders, slips, tables, params.proved)
    write_explorer(data | params.numbers, snakemake.output.page)
