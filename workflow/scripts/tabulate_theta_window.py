"""Tabulate the numbers of each scene over a window of theta."""

from job import job

from precursors.ensembles.theta_window import theta_window_table
from precursors.support.files import read_table, write_table

if __name__ == "__main__":
    with job() as snakemake:
        write_table(theta_window_table(read_table(snakemake.input.members)), snakemake.output.table)
