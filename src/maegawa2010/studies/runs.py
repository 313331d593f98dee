"""Run the members of a study, and summarise each run."""

import math
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from maegawa2010.studies.members import Study, chain_of
from precursors.analysis.horizon import horizon
from precursors.analysis.slips import slip_rows, slip_table, until_global
from precursors.analysis.summary import summarise
from precursors.model.chain import Chain
from precursors.solver.many import simulate_many
from precursors.solver.run import Record, Run
from precursors.solver.simulate import TransitionLimitError, simulate
from precursors.support.files import write_table

# A batch is held in memory: 200 runs of 10 blocks, or 10 runs of 200 blocks.
BLOCKS_PER_BATCH = 2000
# L_p/L beyond which the experiment's precursors grow faster (Sect. 6.1).
KINK = 0.7
# Error of a transition's time above which single events count as unpredicted.
UNPREDICTED_S = 1e-6
# `predictable` tries this much of a run first, and then twice as much again and again: a
# trial takes 24 runs, and with many blocks only a short time is predictable.
TRIED_S = 0.005
# A run that is made again ends at this fraction of its predictable time, or at its own
# end.
BEFORE = 0.99


def run_chunk(study: Study, chunk: str, path: str) -> None:
    """Run one chunk of a study, such as "1of4", and write a row for each member."""
    i, n = map(int, chunk.split("of"))
    rows = run_members(study.chunk(i, n))
    write_table(rows.rename_axis("member").reset_index(), path)


def run_members(study: Study) -> pd.DataFrame:
    """Run all members of a study on one core.

    Returns
    -------
    DataFrame
        The members, each with the numbers of its run (see `numbers_of`). A run that
        reaches the limit of transitions is summarised up to there.
    """
    size = max(1, BLOCKS_PER_BATCH // max(study.members["n_blocks"], default=1))
    results = [numbers_of([])]
    for _, members in study.members.groupby("duration", sort=False):
        for begin in range(0, len(members), size):
            batch = members.iloc[begin : begin + size]
            chains = [
                chain_of(member, study.seed) for member in batch.to_dict("records")
            ]
            runs = up_to_global_slip(chains, float(batch["duration"].iloc[0]))
            results.append(numbers_of(runs).set_index(batch.index))
    return study.members.join(pd.concat(results))


def numbers_of(runs: Iterable[Record]) -> pd.DataFrame:
    """Summary of each run (see `summarise`), and the growth of its precursors (see
    `speedup`)."""
    runs = list(runs)
    return summarise(runs).assign(speedup=[speedup(slip_rows(run)) for run in runs])


def up_to_global_slip(chains: Sequence[Chain], duration: float) -> Sequence[Run]:
    """Run a batch of chains to their first global slips; a run that reaches the limit of
    transitions ends there."""
    try:
        return simulate_many(chains, duration, "global slip", 1)
    except TransitionLimitError as limit:
        if len(chains) == 1:
            unfinished: Any = limit.run
            return [unfinished]
        return [run for chain in chains for run in up_to_global_slip([chain], duration)]


def speedup(slips: NDArray[np.void]) -> float:
    """Growth of L_p with F_X beyond KINK L over the growth before, from the counted
    events of `slip_rows`.

    The second part ends with the first event of the whole length. The first part ends
    with the last event before it that is no longer than KINK L. NaN if L_p does not grow
    in the first part, or F_X does not grow in the second.
    """
    counted = slips[slips["counted"]]
    front, load, n_blocks = (
        counted[name] for name in ("front", "load_before_N", "n_blocks")
    )
    whole = np.flatnonzero(front == n_blocks)
    if not len(whole) or not slips["is_global"].any():
        return math.nan
    up_to_kink = np.flatnonzero(front[: whole[0]] <= KINK * n_blocks[0])
    three = [0, up_to_kink[-1] if len(up_to_kink) else 0, whole[0]]
    rise = np.diff(front[three])
    span = np.diff(load[three])
    if rise[0] <= 0 or span[1] <= 0:
        return math.nan
    return float(rise[1] * span[0] / (rise[0] * span[1]))


def predictable(run: Run) -> float:
    """Time until which single events can be predicted [s]."""
    tried = min(TRIED_S, run.duration)
    while True:
        same = simulate(run.chain, tried, start_positions=run.start_positions)
        known = horizon(same, UNPREDICTED_S)
        if known < tried or tried == run.duration:
            return known
        tried = min(2.0 * tried, run.duration)


def known_until(run: Run) -> float:
    """Time until which a run can be made again on any machine [s]."""
    until = predictable(run)
    return until if until == run.duration else BEFORE * until


def so_far(run: Run) -> dict[str, float]:
    """The numbers of a run up to its first global slip, or to its end if it has none.

    mu_sapp is the largest F_X/F_Z, and global_slip_s the onset of the last event.
    """
    slips = slip_table(run)
    slips = slips[until_global(slips["is_global"])]
    return {
        "events_to_global_slip": len(slips),
        "events_counted": int(slips["counted"].sum()),
        "mu_sapp": slips["largest_load_N"].max() / run.chain.normal_load,
        "global_slip_s": slips["onset_s"].max(),
    }
