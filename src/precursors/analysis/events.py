"""Slip events of a run: what they are, and the same faster."""

import math
from dataclasses import replace
from typing import NamedTuple, get_type_hints

import numpy as np
from numpy.typing import NDArray

from precursors.solver.run import Record


class Slip(NamedTuple):
    """A slip event: a maximal time interval in which at least one block slides."""

    onset_s: float
    end_s: float
    load_before_N: float  # F_X at the onset
    load_after_N: float  # F_X at the end
    largest_load_N: float  # largest F_X up to the onset
    front: int  # farthest block that slid, 1..N
    n_slid: int  # blocks that slid at some time
    n_simultaneous: int  # most blocks that slid at the same instant
    is_global: bool  # all blocks slid at the same instant


# Of the mean load: a lighter block may slide on while all others stick.
LIGHT = 0.01
SLIP = np.dtype(list(get_type_hints(Slip).items()))


def slip_events_by_definition(run: Record) -> list[Slip]:
    """The definition of slip events, for reading; `slip_events` finds them faster.

    An event ends where no block slides, unless the next one releases at the same
    instant. One that the end of the run cuts off has end and load_after NaN. Blocks
    without load, or with next to none (`Chain.bears_load`), do not count, but are taken
    to slide where all others do.
    """
    bears_load = run.chain.bears_load
    n_blocks = len(bears_load)
    n_loaded = bears_load.sum()
    slips: list[Slip] = []
    sliding: set[int] = set()
    largest = -math.inf
    goes_on = False
    for (time, block, mode, load), pause in zip(
        run.transitions, run.intervals[1:], strict=True
    ):
        if not mode:
            sliding.discard(block)
        elif bears_load[block - 1]:
            sliding.add(block)
        largest = max(largest, load)
        if not goes_on:
            onset = (time, load, largest)
            slid: set[int] = set()
            at_once = 0
        goes_on = bool(sliding) or pause == 0.0
        slid |= sliding
        at_once = max(at_once, len(sliding))
        is_global = at_once == n_loaded
        so_far = Slip(
            onset_s=onset[0],
            end_s=math.nan if sliding else time,
            load_before_N=onset[1],
            load_after_N=math.nan if sliding else load,
            largest_load_N=onset[2],
            front=n_blocks if is_global else max(slid, default=0),
            n_slid=n_blocks if len(slid) == n_loaded else len(slid),
            n_simultaneous=n_blocks if is_global else at_once,
            is_global=is_global,
        )
        if slid and not goes_on:
            slips.append(so_far)
    return [*slips, so_far] if goes_on and slid else slips


def slip_events(run: Record) -> NDArray[np.void]:
    """Slip events of a run: a row of dtype SLIP for each of
    `slip_events_by_definition`."""
    time = run.transitions["time"]
    block = run.transitions["block"]
    load = run.transitions["tangential_load"]
    n_blocks = run.chain.n_blocks
    bears_load = run.chain.bears_load
    n_loaded = bears_load.sum()
    sliding = (run.transitions["mode"] != 0) & bears_load[block - 1]
    # Sorting by block shows what each block did before.
    order = np.argsort(block, kind="stable")
    was_sliding = np.zeros(len(block), dtype=bool)
    was_sliding[order[1:]] = (np.diff(block[order]) == 0) & sliding[order][:-1]
    n_sliding = np.cumsum(sliding.astype(int) - was_sliding)

    is_last = (n_sliding == 0) & (run.intervals[1:] > 0.0)
    is_last[-1:] = True
    last = np.flatnonzero(is_last)
    first = np.append(0, last + 1)[:-1]
    event = np.cumsum(is_last) - is_last
    each_once = np.unique((event * (n_blocks + 1) + block)[sliding])
    n_slid = np.bincount(each_once // (n_blocks + 1), minlength=len(last))
    at_once = np.maximum.reduceat(n_sliding, first)
    is_global = at_once == n_loaded
    is_finished = n_sliding[last] == 0

    slips = np.empty(len(last), SLIP)
    slips["onset_s"] = time[first]
    slips["end_s"] = np.where(is_finished, time[last], np.nan)
    slips["load_before_N"] = load[first]
    slips["load_after_N"] = np.where(is_finished, load[last], np.nan)
    slips["largest_load_N"] = np.maximum.accumulate(load)[first]
    farthest = np.maximum.reduceat(sliding * block, first)
    slips["front"] = np.where(is_global, n_blocks, farthest)
    slips["n_slid"] = np.where(n_slid == n_loaded, n_blocks, n_slid)
    slips["n_simultaneous"] = np.where(is_global, n_blocks, at_once)
    slips["is_global"] = is_global
    return slips[n_slid > 0]


def told_of_light_blocks(run: Record) -> str:
    """Words about the lightest block, if the run has other slip events with than
    without the blocks that bear less than `LIGHT`; else empty."""
    chain = run.chain
    light = chain.bears_load & (chain.weights < LIGHT * chain.weights.mean())
    others = replace(run, chain=replace(chain, weights=chain.weights * ~light))
    n, without = (len(slip_events(one)) for one in (run, others))
    if n == without:
        return ""
    block = np.where(light, chain.weights, np.inf).argmin()
    does = "keeps events from ending" if n < without else "has events of its own"
    return (
        f"block {block + 1}, with {chain.weights[block]:.2g} N, {does}: "
        f"{n} in all, {without} without it"
    )


def transitions_right(run: Record, true: Record) -> int:
    """Number of transitions before the first that is missing or whose block or mode is
    wrong."""
    changes = ["block", "mode"]
    return agreeing(run.transitions[changes], true.transitions[changes])


def agreeing(mine: NDArray[np.void], theirs: NDArray[np.void]) -> int:
    """Number of rows that agree before the first that does not, or an end."""
    n = min(len(mine), len(theirs))
    return int(np.argmin(np.append(mine[:n] == theirs[:n], False)))
