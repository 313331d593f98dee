"""The definition of a slip event, for many runs at once."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from precursors.solver.record import TRANSITION
from precursors.solver.run import Record

EVENT = np.dtype(
    [
        ("run", "i8"),  # index of the run
        ("first", "i8"),  # index of its first transition in the run
        ("last", "i8"),  # and of its last one
        ("onset", "f8"),  # [s]
        ("end", "f8"),  # [s]
        ("load_before", "f8"),  # F_X at the onset [N]
        ("load_after", "f8"),  # F_X at the end [N]
        ("largest_load", "f8"),  # largest F_X up to the onset [N]
        ("front", "i8"),  # farthest block that slid, 1..N
        ("n_slid", "i8"),  # blocks that slid at some time
        ("n_simultaneous", "i8"),  # most blocks that slid at the same instant
        ("is_global", "?"),  # all blocks slid at the same instant
    ]
)


def slip_events(runs: Sequence[Record]) -> NDArray[np.void]:
    """Slip events of some runs: maximal time intervals in which at least one block
    slides.

    Blocks without load do not count, but are taken to slide where all others do: front,
    n_slid and n_simultaneous are then N. An event ends where no block slides, unless
    the next one releases at the same instant. One that the end of its run cuts off has
    end and load_after NaN.

    Returns
    -------
    structured array of dtype EVENT
        One row per event, in the order of the runs and of time.
    """
    joined = [np.empty(0, TRANSITION), *(run.transitions for run in runs)]
    time, of_block, mode, load = (
        np.concatenate([each[name] for each in joined])
        for name in TRANSITION.names or ()
    )
    pauses = np.concatenate([[], *(run.intervals[1:] for run in runs)])
    lengths = np.array([len(run.transitions) for run in runs], dtype=int)
    n_blocks = np.array([run.chain.n_blocks for run in runs], dtype=int)
    n_loaded = np.array([np.count_nonzero(r.chain.weights) for r in runs], dtype=int)
    starts = np.cumsum(lengths) - lengths
    run = np.repeat(np.arange(len(runs)), lengths)

    loads = [run.chain.weights[run.transitions["block"] - 1] for run in runs]
    sliding = (mode != 0) & (np.concatenate([time[:0], *loads]) > 0.0)
    # Every block of every run has its own number, so that sorting shows what each block
    # did before.
    block = of_block + np.repeat(np.cumsum(n_blocks) - n_blocks, lengths)
    order = np.argsort(block.astype(np.min_scalar_type(n_blocks.sum())), kind="stable")
    same_block = block[order][1:] == block[order][:-1]
    was_sliding = np.zeros(len(block), dtype=bool)
    was_sliding[order[1:]] = same_block & sliding[order][:-1]
    total = np.append(0, np.cumsum(sliding.astype(int) - was_sliding))
    n_sliding = total[1:] - np.repeat(total[starts], lengths)

    ends = (n_sliding == 0) & (pauses > 0.0)
    ends[(starts + lengths - 1)[lengths > 0]] = True
    lasts = np.flatnonzero(ends)
    firsts = np.append(0, lasts + 1)[:-1]
    event = np.repeat(np.arange(len(lasts)), lasts - firsts + 1)

    events = np.empty(len(lasts), EVENT)
    events["run"] = run[firsts]
    events["first"] = firsts - starts[events["run"]]
    events["last"] = lasts - starts[events["run"]]
    events["onset"] = time[firsts]
    events["load_before"] = load[firsts]
    so_far = [np.maximum.accumulate(run.transitions["tangential_load"]) for run in runs]
    events["largest_load"] = np.concatenate([load[:0], *so_far])[firsts]
    finished = n_sliding[lasts] == 0
    events["end"] = np.where(finished, time[lasts], np.nan)
    events["load_after"] = np.where(finished, load[lasts], np.nan)
    events["front"] = np.maximum.reduceat(sliding * of_block, firsts)
    n_all = n_blocks.sum() + 1
    slid = np.unique((event * n_all + block)[sliding]) // n_all
    events["n_slid"] = np.bincount(slid, minlength=len(lasts))
    events["n_simultaneous"] = np.maximum.reduceat(n_sliding, firsts)
    for name in ("n_slid", "n_simultaneous"):
        is_all = events[name] == n_loaded[events["run"]]
        events[name] = np.where(is_all, n_blocks[events["run"]], events[name])
    events["is_global"] = is_all
    events["front"] = np.where(is_all, n_blocks[events["run"]], events["front"])
    return events[events["n_slid"] > 0]
