"""Tabulate the global slips of one long run a scene."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pandas as pd
from job import job

from precursors.ensembles.long_runs import global_slips, long_run_statistics
from precursors.model.chain import Chain
from precursors.solver.simulate import simulate
from precursors.support.files import write_table


def main(
    sliders: Mapping[str, Mapping[str, Any]], duration: float, slips: str | Path, statistics: str | Path
) -> None:
    """Write every global slip of runs of `duration` [s], and the statistics of their peak loads."""
    tables = []
    for scene, slider in sliders.items():
        table = global_slips(simulate(Chain.from_slider(**slider), duration))
        tables.append(pd.DataFrame({"scene": scene, "theta": slider["theta"], **table}))
    together = pd.concat(tables, ignore_index=True)
    write_table(together, slips)
    write_table(long_run_statistics(together), statistics)


if __name__ == "__main__":
    with job() as snakemake:
        main(
            snakemake.params.sliders,
            snakemake.params.duration,
            snakemake.output.slips,
            snakemake.output.statistics,
        )
