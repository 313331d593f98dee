"""Run the larger models with more and more blocks, and tabulate what N does to their numbers."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from job import job

from precursors.hierarchy.larger_resolution import resolution_models_table, run_models
from precursors.support.files import write_table


def main(slider: Mapping[str, Any], settings: Mapping[str, Any], table: str | Path, runs: str | Path) -> None:
    """Write a row per model, N and quantity, and one per run and quantity."""
    found = run_models(slider, settings)
    write_table(found, runs)
    write_table(resolution_models_table(found), table)


if __name__ == "__main__":
    with job() as snakemake:
        main(
            snakemake.params.slider,
            snakemake.params.settings,
            snakemake.output.table,
            snakemake.output.runs,
        )
