"""Write the explorer: one HTML page that solves the chain in the browser."""

import pandas as pd
from job import job

from maegawa2010.explorer.page import proved_slider, write_explorer
from maegawa2010.studies.horizon.chains import chain_duration
from maegawa2010.studies.printed_digits.tables import HALF_A_DIGIT
from precursors.analysis.summary import summary_of

with job() as snakemake:
    params = snakemake.params
    found = [summary_of(pd.read_csv(slips)) for slips in snakemake.input.slips]
    scenes = [
        {"slider": slider, "mu_sapp": slip.mu_sapp if slip.reached else None}
        for slider, slip in zip(params.sliders, found, strict=True)
    ]
    proved = [
        {"slider": proved_slider(values), "duration": chain_duration(values)}
        for values in params.proved.values()
    ]
    data = {"scenes": scenes, "proved": proved, "half_a_digit": HALF_A_DIGIT}
    write_explorer(data | params.numbers, snakemake.output.page)
