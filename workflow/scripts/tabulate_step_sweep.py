"""Tabulate what the step of RK4 does to the numbers that the paper prints."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pandas as pd
from job import job

from precursors.accuracy.step_sweep import charted_steps, sweep
from precursors.model.chain import Chain
from precursors.support.files import write_table


def main(
    sliders: Mapping[str, dict[str, Any]], durations: Mapping[str, float], full: bool, output: str | Path
) -> None:
    """Write one row per scene, method and step; the exact solver's has no step."""
    rows = [
        {"scene": scene, "theta": slider["theta"], **row}
        for scene, slider in sliders.items()
        for row in sweep(Chain.from_slider(**slider), durations[scene], charted_steps(full))
    ]
    write_table(pd.DataFrame(rows), output)


if __name__ == "__main__":
    with job() as snakemake:
        main(
            snakemake.params.sliders,
            snakemake.params.durations,
            bool(snakemake.wildcards.full),
            snakemake.output.table,
        )
