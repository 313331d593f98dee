"""Tabulate each number over the noise, and whether two loadings have the same."""

from gather_members import gathered
from job import job

from precursors.ensembles.noise import differences_table, noise_table
from precursors.support.files import write_table

if __name__ == "__main__":
    with job() as snakemake:
        members = gathered(snakemake)
        write_table(noise_table(members), snakemake.output.table)
        write_table(differences_table(members), snakemake.output.differences)
