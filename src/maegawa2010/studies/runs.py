"""The runs of a study's members, each with its numbers."""

import math
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from maegawa2010.studies.members import Study, chain_of
from precursors.analysis.slips import slip_events
from precursors.analysis.summary import summarise
from precursors.model.chain import Chain
from precursors.solver.many import simulate_many
from precursors.solver.run import Record, Run
from precursors.solver.simulate import TransitionLimitError
from precursors.support.files import write_table

# Runs of a batch are in memory at the same time: some 200 of 10 blocks, 10 of 200.
BLOCKS_PER_BATCH = 2000
# L_p/L from which the length of the experiment's precursors grows faster (Sect. 6.1).
KINK = 0.7


def run_chunk(study: Study, chunk: str, path: str) -> None:
    """Run one chunk of a study, "1of4" to "4of4": every n-th member, a row each with
    what its run gave."""
    i, n = map(int, chunk.split("of"))
    found = run_members(study.chunk(i, n))
    write_table(found.rename_axis("member").reset_index(), path)


def run_members(study: Study) -> pd.DataFrame:
    """Run all members of a study on one core.

    Returns
    -------
    DataFrame
        The members, each with the numbers of its run (see `numbers_of`). A member that
        meets the limit of transitions is summarised as far as it came.
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
    """A row for each run: its summary (see `summarise`), and the growth of L_p (see
    `speedup`)."""
    runs = list(runs)
    return summarise(runs).assign(speedup=[speedup(slip_events(run)) for run in runs])


def up_to_global_slip(chains: Sequence[Chain], duration: float) -> Sequence[Run]:
    """Run a batch; a run that meets the limit of transitions is kept as far as it
    came."""
    try:
        return simulate_many(chains, duration, "global slip", 1)
    except TransitionLimitError as limit:
        if len(chains) == 1:
            so_far: Any = limit.run
            return [so_far]
        return [run for chain in chains for run in up_to_global_slip([chain], duration)]


def speedup(slips: NDArray[np.void]) -> float:
    """Growth of L_p with F_X beyond KINK L, over that before, in the events counted of
    `slip_events`.

    The first event of the whole length ends the second, and the last one before it of
    up to KINK L divides the two. NaN where one of them has no rise of L_p or F_X.
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
