"""Tabulate convergence with N: each number, both counts of events, limits and local exponents."""

import pandas as pd
from gather_members import gathered
from job import job

from precursors.ensembles import resolution
from precursors.ensembles.noise import noise_table
from precursors.support.files import read_table, write_table

if __name__ == "__main__":
    with job() as snakemake:
        params, output = snakemake.params, snakemake.output
        runs = pd.concat([read_table(snakemake.input.noise), gathered(snakemake)])
        members = resolution.with_front_speed(
            runs.sort_values("n_blocks", kind="stable"), params.slider["length"]
        )
        write_table(noise_table(members, resolution.POINT, resolution.QUANTITIES), output.table)
        write_table(resolution.counts_table(members, params.uniform), output.counts)
        limits = resolution.extrapolation_table(members, params.extrapolate_from)
        limits["wave_speed_m_per_s"] = resolution.wave_speed(params.slider)
        write_table(limits, output.limits)
        write_table(resolution.exponents_table(members), output.exponents)
