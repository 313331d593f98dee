"""Tabulate the numbers of each scene over a window of theta."""

from gather_members import gathered
from job import job

from precursors.ensembles.theta_window import theta_window_table
from precursors.support.files import write_table

if __name__ == "__main__":
    with job() as snakemake:
        write_table(theta_window_table(gathered(snakemake)), snakemake.output.table)
