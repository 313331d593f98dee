"""Tabulate the largest Lyapunov exponent of each scene, from a long run."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pandas as pd
from job import job

from precursors.analysis.lyapunov import lyapunov_exponent
from precursors.model.chain import Chain
from precursors.solver.simulate import simulate
from precursors.support.files import write_table


def main(sliders: Mapping[str, Mapping[str, Any]], duration: float, output: str | Path) -> None:
    """Write one row a scene; a scene that has no exponent (one block, few events) has an empty one."""
    write_table(
        pd.DataFrame(
            [{"scene": name, "theta": s["theta"], **row(s, duration)} for name, s in sliders.items()]
        ),
        output,
    )


def row(slider: Mapping[str, Any], duration: float) -> dict[str, float]:
    """Exponent of a run of `duration` [s], with the half width of its 95 % confidence interval."""
    run = simulate(Chain.from_slider(**slider), duration)
    names = {
        "exponent_per_s": "per_second",
        "uncertainty_per_s": "per_second_uncertainty",
        "exponent_per_transition": "per_transition",
        "uncertainty_per_transition": "per_transition_uncertainty",
        "events": "n_events",
        "transitions": "n_transitions",
        "start_s": "start",
        "end_s": "end",
    }
    try:
        exponent = lyapunov_exponent(run)
    except ValueError:
        return dict.fromkeys(names, float("nan"))
    return {column: getattr(exponent, name) for column, name in names.items()}


if __name__ == "__main__":
    with job() as snakemake:
        main(snakemake.params.sliders, snakemake.params.duration, snakemake.output.table)
