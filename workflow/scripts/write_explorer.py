"""Write the explorer: one HTML page that solves the chain in the browser."""

import pandas as pd
from job import job

from precursors.figures.explorer.page import (
    Proved,
    Scene,
    counted_events,
    proved_slider,
    write_explorer,
)
from precursors.proof.chains import chain_duration

with job() as snakemake:
    params = snakemake.params
    slips = map(pd.read_csv, snakemake.input.slips)
    scenes = map(Scene, params.titles, params.sliders, map(counted_events, slips))
    proved = [
        Proved(proved_slider(values), chain_duration(values))
        for values in params.proved.values()
    ]
    write_explorer([*scenes], proved, params.duration, snakemake.output.page)
