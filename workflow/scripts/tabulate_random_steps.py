"""Tabulate how often RK4 with steps drawn at random gives the six numbers of the paper."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from job import job

from precursors.reproduction.random_steps import draws_table, random_steps_table
from precursors.support.files import read_table, write_table


def main(
    definitions: str | Path,
    slider: Mapping[str, Any],
    duration: float,
    settings: Mapping[str, Any],
    n: int,
    paper: Sequence[Mapping[str, float]],
    output: str | Path,
) -> None:
    """Write one row per size of theta, rule of switching and question, from n steps."""
    draws = draws_table(slider, duration, settings["theta"], settings, n)
    papers = [scene.get(name, float("nan")) for name in ("events_kept", "mu_sapp") for scene in paper]
    write_table(random_steps_table(draws, read_table(definitions), papers), output)


if __name__ == "__main__":
    with job() as snakemake:
        settings = snakemake.params.settings
        main(
            snakemake.input.definitions,
            snakemake.params.slider,
            snakemake.params.duration,
            settings,
            settings["draws_full"] if snakemake.wildcards.full else settings["draws"],
            snakemake.params.paper,
            snakemake.output.table,
        )
