"""Slip events of a run: their definition, a fast search, and the events of Fig. 13."""

import math
from dataclasses import replace
from typing import NamedTuple, get_type_hints

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike, NDArray

from precursors.model.chain import Chain
from precursors.solver.run import Record

# Share of the mean load; a lighter block may go on sliding while all others stick.
LIGHT = 0.01
# Columns of `slip_table` that identify the slider, and the attributes of its chain.
OF_SLIDER = {
    "theta": "theta",
    "n_blocks": "n_blocks",
    "normal_load_N": "normal_load",
    "slider_length_m": "length",
    "mu_k": "mu_k",
}


class Slip(NamedTuple):
    """A slip event: a maximal time interval in which at least one block slides."""

    onset_s: float
    end_s: float
    load_before_N: float  # F_X at the onset
    load_after_N: float  # F_X at the end
    largest_load_N: float  # largest F_X up to the onset
    front: int  # farthest block that slid, 1..N
    n_slid: int  # number of blocks that slid
    n_simultaneous: int  # largest number of blocks that slid at the same instant
    is_global: bool  # all blocks slid at the same instant


SLIP = np.dtype(list(get_type_hints(Slip).items()))
# A row of `slip_table`: a slip, whether it is counted, and the slider.
ROW = np.dtype(
    [
        *SLIP.descr,
        ("counted", bool),
        ("front_length_m", float),
        *((name, int if name == "n_blocks" else float) for name in OF_SLIDER),
    ]
)


def slip_events_by_definition(run: Record) -> list[Slip]:
    """Return the slip events; this code defines them, and `slip_events` is faster.

    An event ends when no block slides, unless another is released at the same instant.
    If the run ends during an event, its end and load_after are NaN. Blocks with no load
    or almost none do not count (`Chain.bears_load`), but are assumed to slide if all
    others do.
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
    """Return the rows of `slip_table` as an array.

    They are the events of `slip_events_by_definition`, which takes five times as long.
    """
    time = run.transitions["time"]
    block = run.transitions["block"]
    load = run.transitions["tangential_load"]
    n_blocks = run.chain.n_blocks
    bears_load = run.chain.bears_load
    n_loaded = bears_load.sum()
    sliding = (run.transitions["mode"] != 0) & bears_load[block - 1]
    # Sorted by block, the row before is the block's last transition.
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
    return rows_of(slips[n_slid > 0], run.chain)


def rows_of(slips: NDArray[np.void], chain: Chain) -> NDArray[np.void]:
    """Return rows of `slip_table` (dtype ROW) for slip events of a chain (dtype
    SLIP)."""
    rows = np.empty(len(slips), ROW)
    for name in SLIP.names or ():
        rows[name] = slips[name]
    rows["counted"] = counted(slips)
    rows["front_length_m"] = slips["front"] * chain.length / chain.n_blocks
    for column, name in OF_SLIDER.items():
        rows[column] = getattr(chain, name)
    return rows


def slip_table(run: Record) -> pd.DataFrame:
    """Return all slip events of a run, with units in the names of the columns.

    The columns are those of `find_slips`, whether Fig. 13 counts the event (counted),
    and L_p (front_length_m). The others identify the slider and are the same in every
    row: theta (NaN if unknown), n_blocks, normal_load_N (F_Z), slider_length_m (L) and
    mu_k.
    """
    return pd.DataFrame(slip_events(run))


def find_slips(run: Record) -> pd.DataFrame:
    """Return the slip events of a run: maximal time intervals in which a block slides.

    Returns
    -------
    DataFrame
        One row per event: onset, end [s], load_before, load_after (F_X at onset and
        end), largest_load (largest F_X up to the onset) [N], front (farthest block that
        slid, 1..N), n_slid (number of blocks that slid), n_simultaneous (largest number
        that slid at the same instant), is_global (all N slid at the same instant). If
        the run ends during an event, its end and load_after are NaN.
    """
    slips = slip_table(run)[list(Slip._fields)]
    return slips.rename(columns=lambda name: name.removesuffix("_s").removesuffix("_N"))


def find_precursors(slips: pd.DataFrame) -> pd.DataFrame:
    """Return the events of Fig. 13: those up to the first global slip that are not
    short.

    The global slip is included. An event is short if its front is strictly less than
    the farthest front before it. Without a global slip, all events that are not short
    are returned.
    """
    return slips[counted(slips)]


def counted(slips: pd.DataFrame | NDArray[np.void]) -> NDArray[np.bool_]:
    """Which events Fig. 13 counts (see `find_precursors`)."""
    front = np.asarray(slips["front"])
    is_short = front < np.maximum.accumulate(front)
    return until_global(slips["is_global"]) & ~is_short


def until_global(is_global: ArrayLike) -> NDArray[np.bool_]:
    """Which events do not come after the first global slip."""
    is_global = np.asarray(is_global, bool)
    return np.cumsum(is_global) - is_global == 0


def describe_light_blocks(run: Record) -> str:
    """Describe the lightest block if light blocks change the number of slip events.

    Blocks are light if they bear less than `LIGHT`. The result is "" if their absence
    changes nothing.
    """
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
