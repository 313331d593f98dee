"""Tabulate the number of slip events beside the law for it."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from job import job

from precursors.ensembles.event_law import event_law_table
from precursors.support.files import read_table, write_table


def main(members: str | Path, slider: Mapping[str, Any], output: str | Path) -> None:
    """Write a row per chain: the law, the runs, and the law's assumptions one by one."""
    write_table(event_law_table(read_table(members), slider), output)


if __name__ == "__main__":
    with job() as snakemake:
        main(snakemake.input.members, snakemake.params.slider, snakemake.output.table)
