"""Simulate a scene: its run, its slips and its load curve."""

from pathlib import Path
from typing import Any

from job import job

from precursors.analysis.load_curve import load_trace
from precursors.analysis.slips import slip_table
from precursors.model.chain import Chain
from precursors.solver.run import Run
from precursors.solver.simulate import TransitionLimitError, simulate
from precursors.support.files import write_table


def main(
    slider: dict[str, Any],
    duration: float,
    additions: dict[str, float],
    output: str | Path,
    slips: str | Path,
    trace: str | Path,
) -> None:
    """Run the chain of a scene for `duration` [s]; a run that meets its cap on transitions is kept too.

    The slip table has every event; `counted` tells those of Fig. 13. The trace is the exact tangential load
    at points between which it is straight to 1e-4 N, every transition among them.
    """
    chain = Chain.from_slider(**slider)
    try:
        if any(additions.values()):
            from precursors.hierarchy.larger import LargerChain, simulate_with_accuracy

            run = simulate_with_accuracy(LargerChain(chain, **additions), duration)
        else:
            run = simulate(chain, duration=duration)
    except TransitionLimitError as error:
        error.run.save(Path(output).with_suffix(".unfinished.h5"), slider)
        raise
    run.save(output, slider)
    run = Run.load(output)  # which has theta and F_Z as they are given
    write_table(slip_table(run), slips)
    write_table(load_trace(run), trace)


if __name__ == "__main__":
    with job() as snakemake:
        params = snakemake.params
        main(params.slider, params.duration, params.additions, *snakemake.output)
