"""Run the studies of the larger chain: medians, differences of loadings, and where creep runs away."""

import pandas as pd
from job import job

from precursors.hierarchy.larger_study import differences_table, medians_table, nucleation_table, run_study
from precursors.support.files import write_table

if __name__ == "__main__":
    with job() as snakemake:
        slider, settings = snakemake.params.slider, snakemake.params.settings
        studies = settings["studies"].items()
        runs = pd.concat([run_study(slider, name, study, settings) for name, study in studies])
        write_table(medians_table(runs), snakemake.output.medians)
        write_table(differences_table(runs), snakemake.output.differences)
        write_table(nucleation_table(slider, settings["nucleation"]), snakemake.output.nucleation)
