"""Check Eq. 15 for the chains of some scenes, each pushed for at most `duration` [s]: one row per check."""

from job import job

from precursors.model.chain import Chain
from precursors.reproduction.eq15 import eq15_table
from precursors.support.files import write_table

if __name__ == "__main__":
    with job() as snakemake:
        chains = {name: Chain.from_slider(**slider) for name, slider in snakemake.params.sliders.items()}
        write_table(eq15_table(chains, snakemake.params.duration), snakemake.output.table)
