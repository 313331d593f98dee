"""Gather the chunks of a study in one table: one row per member."""

import pandas as pd
from job import job

from precursors.ensembles.study import gather
from precursors.support.files import write_table


def gathered(snakemake) -> pd.DataFrame:  # type: ignore[no-untyped-def]
    """The members of the study whose chunks are the input, written down as well."""
    members = gather(snakemake.input.chunks)
    write_table(members, snakemake.output.members)
    return members


if __name__ == "__main__":
    with job() as snakemake:
        gathered(snakemake)
