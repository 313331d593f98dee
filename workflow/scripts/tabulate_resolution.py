"""Tabulate what the number of blocks does to the paper's numbers, and where they go as it grows."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from job import job

from precursors.ensembles import resolution
from precursors.support.files import read_table, write_table


def main(
    members: str | Path, slider: Mapping[str, Any], fit_from: int, outputs: Mapping[str, str | Path]
) -> None:
    """Write a row per scene, N and number, both readings of global slip, limits and local exponents."""
    runs = read_table(members)
    table = resolution.resolution_table(runs, slider["length"])
    write_table(resolution.with_estimates(table, slider), outputs["table"])
    write_table(resolution.readings_table(runs), outputs["readings"])
    write_table(resolution.extrapolation_table(runs, slider["length"], fit_from), outputs["limits"])
    write_table(resolution.exponents_table(runs), outputs["exponents"])


if __name__ == "__main__":
    with job() as snakemake:
        main(
            snakemake.input.members,
            snakemake.params.slider,
            snakemake.params.fit_from,
            dict(snakemake.output.items()),
        )
