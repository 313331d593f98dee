"""Time the transitions of longer and longer chains."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from job import job  # before NumPy: it sets the number of threads

# isort: split

from precursors.accuracy.cost_per_event import measure_growth
from precursors.support.files import write_table


def main(size: Mapping[str, Any], output: str | Path) -> None:
    """Write one row per kind of run and number of blocks; `size` is as in the configuration."""
    table = measure_growth(
        size["sizes"], size["repetitions"], size["least_transitions"], size["transitions_per_block"]
    )
    write_table(table, output)


if __name__ == "__main__":
    with job() as snakemake:
        main(snakemake.params.size, snakemake.output.table)
