"""Tabulate the ways in which methods fail: the numbers that show it, and the curves that draw it."""

from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path

import pandas as pd
from job import job

from precursors.accuracy.failures import WAYS
from precursors.support.files import write_table


def main(output: str | Path, curves: Mapping[str, str | Path]) -> None:
    """Write the numbers of all ways to fail in one table, and the curves of each in a table of its own."""
    numbers = []
    for way in WAYS:
        failure = way.measure()
        numbers += [{"way": way.name, **asdict(number)} for number in failure.numbers]
        write_table(failure.curves, curves[way.name])
    write_table(pd.DataFrame(numbers), output)


if __name__ == "__main__":
    with job() as snakemake:
        main(
            snakemake.output.table,
            dict(zip([way.name for way in WAYS], snakemake.output.curves, strict=True)),
        )
