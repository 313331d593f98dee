"""Check Eq. 15 for some scenes, one row per check, and tabulate the load against the speed of the drive."""

from job import job

from precursors.model.chain import Chain
from precursors.reproduction.eq15 import drive_speeds_table, eq15_table
from precursors.support.files import write_table

if __name__ == "__main__":
    with job() as snakemake:
        chains = {name: Chain.from_slider(**slider) for name, slider in snakemake.params.sliders.items()}
        speeds = drive_speeds_table(chains)
        write_table(speeds, snakemake.output.speeds)
        write_table(eq15_table(chains, snakemake.params.duration, speeds), snakemake.output.table)
