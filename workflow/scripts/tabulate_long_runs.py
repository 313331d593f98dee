"""Tabulate the global slips of one long run a scene, and the statistics of their peak loads."""

import pandas as pd
from job import job

from precursors.ensembles.long_runs import global_slips, long_run_statistics
from precursors.model.chain import Chain
from precursors.solver.simulate import simulate
from precursors.support.files import write_table

if __name__ == "__main__":
    with job() as snakemake:
        tables = []
        for scene, slider in snakemake.params.sliders.items():
            table = global_slips(simulate(Chain.from_slider(**slider), snakemake.params.duration))
            tables.append(pd.DataFrame({"scene": scene, "theta": slider["theta"], **table}))
        together = pd.concat(tables, ignore_index=True)
        write_table(together, snakemake.output.slips)
        write_table(long_run_statistics(together), snakemake.output.statistics)
