"""Tabulate the number of slip events beside the law for it."""

from gather_members import gathered
from job import job

from precursors.ensembles.event_law import event_law_table
from precursors.support.files import write_table

if __name__ == "__main__":
    with job() as snakemake:
        write_table(event_law_table(gathered(snakemake), snakemake.params.slider), snakemake.output.table)
