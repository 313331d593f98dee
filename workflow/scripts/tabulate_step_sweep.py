"""Tabulate what the step of RK4 does to the numbers that the paper prints."""

from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any

import pandas as pd
from job import job

from precursors.accuracy.step_sweep import steps_between, sweep
from precursors.model.chain import Chain
from precursors.support.files import write_table

UNITS = {"step": "step_s", "global_slip_time": "global_slip_time_s"}


def main(
    sliders: Mapping[str, dict[str, Any]],
    durations: Mapping[str, float],
    ranges: Mapping[str, Any],
    output: str | Path,
) -> None:
    """Write one row per scene, method and step; the exact solver's has no step."""
    steps = {
        method: steps_between(ranges["coarsest"], ranges[finest], ranges["per_decade"])
        for method, finest in (("rk4_skip", "finest"), ("rk4", "finest_every_step"))
    }
    rows = [
        {"scene": scene, "theta": slider["theta"], **asdict(outcome)}
        for scene, slider in sliders.items()
        for outcome in sweep(Chain.from_slider(**slider), durations[scene], steps)
    ]
    write_table(pd.DataFrame(rows).rename(columns=UNITS), output)


if __name__ == "__main__":
    with job() as snakemake:
        main(
            snakemake.params.sliders,
            snakemake.params.durations,
            snakemake.params.ranges,
            snakemake.output.table,
        )
