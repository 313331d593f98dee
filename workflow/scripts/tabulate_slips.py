"""Tabulate the slip events of a run: when, under which load, how far."""

from pathlib import Path

from job import job
from tables import write_table

from precursors.run import Run
from precursors.slips import find_precursors, find_slips

UNITS = {"onset": "onset_s", "end": "end_s", "load_before": "load_before_N", "load_after": "load_after_N"}


def main(run: str | Path, output: str | Path) -> None:
    """Write every slip event; `kept` tells the rows of Fig. 13."""
    slips = find_slips(Run.load(run))
    kept = slips.index.isin(find_precursors(slips).index)
    write_table(slips.rename(columns=UNITS).assign(kept=kept), output)


if __name__ == "__main__":
    with job() as snakemake:
        main(snakemake.input.run, snakemake.output.table)
