"""Run the larger models with more and more blocks: a row per run, and one per model, N and quantity."""

from job import job

from precursors.hierarchy.larger_resolution import resolution_models_table, run_models
from precursors.support.files import write_table

if __name__ == "__main__":
    with job() as snakemake:
        found = run_models(snakemake.params.slider, snakemake.params.settings)
        write_table(found, snakemake.output.runs)
        write_table(resolution_models_table(found), snakemake.output.table)
