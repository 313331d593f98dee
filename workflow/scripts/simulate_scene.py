"""Simulate a scene and store its run."""

from pathlib import Path
from typing import Any

from job import job

from precursors.model.chain import Chain
from precursors.solver.simulate import TransitionLimitError, simulate


def main(slider: dict[str, Any], duration: float, output: str | Path) -> None:
    """Run the chain of a scene for `duration` [s]; a run that meets its cap on transitions is kept too."""
    try:
        simulate(Chain.from_slider(**slider), duration=duration).save(output, slider)
    except TransitionLimitError as error:
        error.run.save(Path(output).with_suffix(".unfinished.h5"), slider)
        raise


if __name__ == "__main__":
    with job() as snakemake:
        main(snakemake.params.slider, snakemake.params.duration, snakemake.output.run)
