"""The runs of a study's members, each with its numbers."""

from collections.abc import Iterable, Sequence
from typing import Any

import pandas as pd

from maegawa2010.paper.readings import speedup
from maegawa2010.studies.members import Study, chain_of
from precursors.analysis.events import slip_events
from precursors.analysis.horizon import horizon
from precursors.analysis.slips import slip_columns, slip_table, up_to_first_global
from precursors.analysis.summary import summaries
from precursors.model.chain import Chain
from precursors.solver.many import simulate_many
from precursors.solver.run import Record, Run
from precursors.solver.simulate import TransitionLimitError, simulate
from precursors.support.files import write_table

# Runs of a batch are in memory at the same time: some 200 of 10 blocks, 10 of 200.
BLOCKS_PER_BATCH = 2000
# Error of a transition's time from which on single events are not predicted.
UNPREDICTED_S = 1e-6
# Of a run, what is tried first, and then twice as much: trying takes 24 runs, and with
# many blocks little is predictable.
TRIED_S = 0.005
# A run that is made again ends so much before that, or where it ends by itself.
BEFORE = 0.99


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
    tables = [slip_columns(slip_events(run), run.chain) for run in runs]
    return summaries(tables).assign(
        speedup=[speedup(table) for table in tables],
        transitions=[len(run.transitions) for run in runs],
    )


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


def predictable(run: Run) -> float:
    """Time until which single events are predicted [s]."""
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
    """The numbers of a run up to its first global slip, or to its end before that:
    mu_sapp is the largest F_X/F_Z, global_slip_s the onset of the last event."""
    slips = up_to_first_global(slip_table(run))
    return {
        "events_to_global_slip": len(slips),
        "events_counted": int(slips["counted"].sum()),
        "mu_sapp": slips["largest_load_N"].max() / run.chain.normal_load,
        "global_slip_s": slips["onset_s"].max(),
    }
