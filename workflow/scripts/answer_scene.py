"""Ask the model of a scene all that it answers."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from job import job

from precursors.hierarchy.models import answers_table
from precursors.model.chain import Chain
from precursors.support.files import write_table


def main(slider: dict[str, Any], model: str, additions: Mapping[str, float], output: str | Path) -> None:
    """Write one row per number that the model answers."""
    write_table(answers_table(Chain.from_slider(**slider), model, additions), output)


if __name__ == "__main__":
    with job() as snakemake:
        main(
            snakemake.params.slider,
            snakemake.params.model,
            snakemake.params.additions,
            snakemake.output.table,
        )
