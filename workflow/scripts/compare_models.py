"""Ask every model what it answers, for the scenes of Fig. 13."""

from collections.abc import Mapping
from pathlib import Path

from job import job

from precursors.hierarchy.compare_models import compare_models
from precursors.model.chain import Chain
from precursors.support.files import write_table


def main(
    scenes: Mapping[str, Chain],
    tolerances: Mapping[str, float],
    additions: Mapping[str, float],
    repetitions: int,
    output: str | Path,
) -> None:
    """Write one row for each scene, question and model that answers it."""
    write_table(compare_models(scenes, tolerances, additions, rounds=repetitions), output)


if __name__ == "__main__":
    with job() as snakemake:
        main(
            {name: Chain.from_slider(**slider) for name, slider in snakemake.params.sliders.items()},
            snakemake.params.tolerances,
            snakemake.params.additions,
            snakemake.params.repetitions,
            snakemake.output.table,
        )
