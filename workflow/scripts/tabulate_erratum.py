"""Tabulate the errors and open points of the paper, each with the number that it makes a difference of."""

from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path

import pandas as pd
from job import job

from precursors.reproduction.erratum import find_errors
from precursors.solver.run import Run
from precursors.support.files import write_table


def main(scenes: Sequence[str], runs: Sequence[str | Path], output: str | Path) -> None:
    """Write one row per number; `scenes` are those of theta < 0, theta = 0 and theta > 0, in this order."""
    trailing, uniform, leading = scenes
    found = {scene: Run.load(path) for scene, path in zip(scenes, runs, strict=True)}
    write_table(pd.DataFrame(map(asdict, find_errors(trailing, uniform, leading, found))), output)


if __name__ == "__main__":
    with job() as snakemake:
        main(snakemake.params.scenes, snakemake.input.runs, snakemake.output.table)
