"""Tabulate the failure modes of methods: the numbers that show them, and the curves that draw them."""

from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path

import pandas as pd
from job import job

from precursors.accuracy.failures import FAILURE_MODES
from precursors.support.files import write_table


def main(output: str | Path, curves: Mapping[str, str | Path]) -> None:
    """Write the numbers of some failure modes in one table, and the curves of each in a table of its own."""
    numbers = []
    for name, path in curves.items():
        failure = FAILURE_MODES[name]()
        numbers += [{"failure_mode": name, **asdict(number)} for number in failure.numbers]
        write_table(failure.curves, path)
    write_table(pd.DataFrame(numbers), output)


if __name__ == "__main__":
    with job() as snakemake:
        main(snakemake.output.table, dict(zip(FAILURE_MODES, snakemake.output.curves, strict=True)))
