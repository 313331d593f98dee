"""Tabulate what the number of blocks does to the paper's numbers, and where they go as it grows."""

from job import job

from precursors.ensembles import resolution
from precursors.support.files import read_table, write_table

if __name__ == "__main__":
    with job() as snakemake:
        runs, slider, output = read_table(snakemake.input.members), snakemake.params.slider, snakemake.output
        table = resolution.resolution_table(runs, slider["length"])
        limits = resolution.extrapolation_table(runs, slider["length"], snakemake.params.fit_from)
        write_table(resolution.with_estimates(table, slider), output.table)
        write_table(resolution.readings_table(runs), output.readings)
        write_table(limits, output.limits)
        write_table(resolution.exponents_table(runs), output.exponents)
