"""Write the explorer: one HTML page that solves the chain in the browser."""

import pandas as pd
from job import job

from precursors.accuracy.proof.chains import chain_duration
from precursors.figures.explorer.page import (
    Proved,
    Scene,
    counted_events,
    proved_slider,
    write_explorer,
)

if __name__ == "__main__":
    with job() as snakemake:
        scenes = [
            Scene(title, slider, counted_events(pd.read_csv(slips)))
            for title, slider, slips in zip(
                snakemake.params.titles, snakemake.params.sliders, snakemake.input.slips, strict=True
            )
        ]
        proved = [
            Proved(proved_slider(values), chain_duration(values))
            for values in snakemake.params.proved.values()
        ]
        write_explorer(scenes, proved, snakemake.params.duration, snakemake.output.page)
