"""Simulate a scene and store its run."""

from pathlib import Path
from typing import Any

from job import job

from precursors.model.chain import Chain
from precursors.solver.simulate import TransitionLimitError, simulate


def main(slider: dict[str, Any], duration: float, additions: dict[str, float], output: str | Path) -> None:
    """Run the chain of a scene for `duration` [s]; a run that meets its cap on transitions is kept too."""
    chain = Chain.from_slider(**slider)
    try:
        if any(additions.values()):
            from precursors.hierarchy.larger import LargerChain, simulate_with_accuracy

            run = simulate_with_accuracy(LargerChain(chain, **additions), duration)
        else:
            run = simulate(chain, duration=duration)
        run.save(output, slider)
    except TransitionLimitError as error:
        error.run.save(Path(output).with_suffix(".unfinished.h5"), slider)
        raise


if __name__ == "__main__":
    with job() as snakemake:
        params = snakemake.params
        main(params.slider, params.duration, params.additions, snakemake.output.run)
