"""Tabulate the tangential load so that straight lines between the rows draw it."""

from pathlib import Path

import numpy as np
import pandas as pd
from job import job
from tables import write_table

from precursors.run import Run
from precursors.slips import find_slips

POINTS_PER_SLIP = 12  # a drop is half a cosine or flatter: straight to 1 % of the drop between 14 points


def main(run_path: str | Path, output: str | Path) -> None:
    """Write the exact F_X at the start, at every transition, at points inside every slip, and at the end."""
    run = Run.load(run_path)
    times = trace_times(run)
    write_table(pd.DataFrame({"time_s": times, "tangential_load_N": run.tangential_load(times)}), output)


def trace_times(run: Run) -> np.ndarray:
    """Times [s] to evaluate the load at, in order: while all blocks stick it grows linearly."""
    slips = find_slips(run)
    end = slips["end"].fillna(run.duration)
    inside = np.linspace(slips["onset"], end, POINTS_PER_SLIP + 2)
    return np.unique(np.concatenate([[0.0, run.duration], run.transitions["time"], inside.ravel()]))


if __name__ == "__main__":
    with job() as snakemake:
        main(snakemake.input.run, snakemake.output.table)
