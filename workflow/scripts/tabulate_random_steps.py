"""Tabulate how often RK4 with steps drawn at random gives the six numbers of the paper."""

from job import job

from precursors.reproduction.random_steps import draws_table, random_steps_table
from precursors.support.files import read_table, write_table

if __name__ == "__main__":
    with job() as snakemake:
        params, settings = snakemake.params, snakemake.params.settings
        n = settings["draws_full"] if snakemake.wildcards.full else settings["draws"]
        draws = draws_table(params.slider, params.duration, settings["theta"], settings, n)
        papers = [
            row.get(name, float("nan")) for name in ("events_counted", "mu_sapp") for row in params.paper
        ]
        table = random_steps_table(draws, read_table(snakemake.input.definitions), papers)
        write_table(table, snakemake.output.table)
