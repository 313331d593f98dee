"""Run one chunk of a study."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from job import job

from precursors.ensembles.catalogue import make_study
from precursors.ensembles.chunks import estimated_seconds, save_chunk
from precursors.ensembles.study import run_members
from precursors.support.progress import Progress


def main(config: Mapping[str, Any], name: str, chunk: str, output: str | Path) -> None:
    """Run the members of a chunk ("first-last") of a study of the configuration and store what they gave."""
    study = make_study(config, name)
    first, last = (int(number) for number in chunk.split("-"))
    with Progress(f"{name} {chunk}", estimated_seconds(study)[first : last + 1], in_file=True) as progress:
        found = run_members(study, first, last + 1, progress)
    save_chunk(output, study, first, found)


if __name__ == "__main__":
    with job() as snakemake:
        main(snakemake.config, snakemake.wildcards.study, snakemake.wildcards.chunk, snakemake.output.chunk)
