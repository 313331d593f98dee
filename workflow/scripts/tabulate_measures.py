"""Tabulate the parameters of the scenes, and how their first global slips come."""

from collections.abc import Mapping
from pathlib import Path

from job import job

from precursors.reproduction.scene_numbers import measures_table
from precursors.solver.run import Run
from precursors.support.files import write_table


def main(runs: Mapping[str, str | Path], output: str | Path) -> None:
    """Write one row per scene."""
    write_table(measures_table({scene: Run.load(path) for scene, path in runs.items()}), output)


if __name__ == "__main__":
    with job() as snakemake:
        main(dict(zip(snakemake.params.scenes, snakemake.input.runs, strict=True)), snakemake.output.table)
