"""Check Eq. 15 and write one row per check."""

from collections.abc import Mapping
from pathlib import Path

from job import job

from precursors.model.chain import Chain
from precursors.reproduction.eq15 import eq15_table
from precursors.support.files import write_table


def main(scenes: Mapping[str, Chain], duration: float, output: str | Path) -> None:
    """Write the checks for the chains of some scenes, each pushed for at most `duration` [s]."""
    write_table(eq15_table(scenes, duration), output)


if __name__ == "__main__":
    with job() as snakemake:
        main(
            {name: Chain.from_slider(**slider) for name, slider in snakemake.params.sliders.items()},
            snakemake.params.duration,
            snakemake.output.table,
        )
