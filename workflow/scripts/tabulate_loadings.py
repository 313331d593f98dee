"""Tabulate whether mu_sapp of the larger models is the same for all distributions of the normal load."""

from job import job

from precursors.hierarchy.larger_resolution import loadings_table
from precursors.support.files import write_table

if __name__ == "__main__":
    with job() as snakemake:
        p = snakemake.params
        write_table(loadings_table(p.slider, p.settings, p.loadings), snakemake.output.table)
