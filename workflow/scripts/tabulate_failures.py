"""Tabulate how methods fail: the numbers that show it, the curves that draw it, and the thresholds."""

from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path

import pandas as pd
from job import job

from precursors.accuracy.failures import FAILURE_MODES
from precursors.accuracy.failures.common import Threshold
from precursors.accuracy.failures.stability import thresholds
from precursors.support.files import write_table


def main(numbers: str | Path, limits: str | Path, curves: Mapping[str, str | Path]) -> None:
    """Write the numbers and thresholds of some failure modes in a table each, and the curves of each mode."""
    rows: list[dict[str, object]] = []
    found: list[Threshold] = list(thresholds())
    for name, path in curves.items():
        failure = FAILURE_MODES[name]()
        rows += [{"failure_mode": name, **asdict(number)} for number in failure.numbers]
        found += failure.thresholds
        write_table(failure.curves, path)
    write_table(pd.DataFrame(rows), numbers)
    table = pd.DataFrame(map(asdict, found))
    write_table(table.assign(ratio=table["measured"] / table["predicted"]), limits)


if __name__ == "__main__":
    with job() as snakemake:
        out = snakemake.output
        main(out.numbers, out.thresholds, dict(zip(FAILURE_MODES, out.curves, strict=True)))
