"""Slip events of a run: their definition, a fast search, and the events of Fig. 13."""

import math
from dataclasses import replace
from typing import NamedTuple, get_type_hints

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike, NDArray

from precursors.model.chain import Chain
from precursors.solver.run import Record

# Share of the mean normal load below which `describe_light_blocks` warns of a block.
LIGHT = 0.01
# Columns of `slip_table` that identify the slider: name and attribute of `Chain`.
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
    """Return the slip events; this code defines them, and `slip_rows` is faster.

    An event ends when the last sliding block stops, unless a block is released at the
    same instant. Blocks with almost no normal load (`Chain.bears_load`) are ignored, with two
    exceptions. `front` and `n_simultaneous` include them if all others slide at the
    same instant; `n_slid` includes them if all others slide during the event.
    """
    bears_load = run.chain.bears_load
    n_blocks = len(bears_load)
    n_loaded = bears_load.sum()
    slips: list[Slip] = []
    sliding: set[int] = set()
    largest = -math.inf
    is_onset = True
    # Interval 0 lies before the first transition.
    for (time, block, mode, load), until_next in zip(
        run.transitions, run.intervals[1:], strict=True
    ):
        if mode == 0:  # the block sticks
            sliding.discard(block)
        elif bears_load[block - 1]:
            sliding.add(block)
        largest = max(largest, load)
        if is_onset:
            onset = (time, load, largest)
            slid: set[int] = set()
            n_simultaneous = 0
        else:
            slips.pop()  # replaced below by the event up to this transition
        slid |= sliding
        n_simultaneous = max(n_simultaneous, len(sliding))
        is_global = n_simultaneous == n_loaded
        event = Slip(
            onset_s=onset[0],
            end_s=math.nan if sliding else time,
            load_before_N=onset[1],
            load_after_N=math.nan if sliding else load,
            largest_load_N=onset[2],
            front=n_blocks if is_global else max(slid, default=0),
            n_slid=n_blocks if len(slid) == n_loaded else len(slid),
            n_simultaneous=n_blocks if is_global else n_simultaneous,
            is_global=is_global,
        )
        slips.append(event)
        is_onset = not sliding and until_next > 0.0
    return [event for event in slips if event.n_slid > 0]


def slip_rows(run: Record) -> NDArray[np.void]:
    """Return the rows of `slip_table` as an array."""
    time = run.transitions["time"]
    block = run.transitions["block"]
    load = run.transitions["tangential_load"]
    n_blocks = run.chain.n_blocks
    bears_load = run.chain.bears_load
    n_loaded = bears_load.sum()
    slides_after = (run.transitions["mode"] != 0) & bears_load[block - 1]
    # Sort the transitions by block. Did a block slide after its previous transition?
    order = np.argsort(block, kind="stable")
    is_same_block = np.diff(block[order]) == 0
    slid_before = np.zeros(len(block), dtype=bool)
    slid_before[order[1:]] = is_same_block & slides_after[order[:-1]]
    n_sliding = np.cumsum(slides_after.astype(int) - slid_before)

    ends_event = (n_sliding == 0) & (run.intervals[1:] > 0.0)
    ends_event[-1:] = True  # a slice, as there may be no transitions
    end = np.flatnonzero(ends_event)
    onset = np.append(0, end + 1)[:-1]
    event = np.cumsum(ends_event) - ends_event  # number of each transition's event
    # Each pair of an event and a block that slid in it, as one number.
    pairs = np.unique((event * (n_blocks + 1) + block)[slides_after])
    n_slid = np.bincount(pairs // (n_blocks + 1), minlength=len(end))
    n_simultaneous = np.maximum.reduceat(n_sliding, onset)
    is_global = n_simultaneous == n_loaded
    is_finished = n_sliding[end] == 0

    slips = np.empty(len(end), SLIP)
    slips["onset_s"] = time[onset]
    slips["end_s"] = np.where(is_finished, time[end], np.nan)
    slips["load_before_N"] = load[onset]
    slips["load_after_N"] = np.where(is_finished, load[end], np.nan)
    slips["largest_load_N"] = np.maximum.accumulate(load)[onset]
    farthest = np.maximum.reduceat(slides_after * block, onset)
    slips["front"] = np.where(is_global, n_blocks, farthest)
    slips["n_slid"] = np.where(n_slid == n_loaded, n_blocks, n_slid)
    slips["n_simultaneous"] = np.where(is_global, n_blocks, n_simultaneous)
    slips["is_global"] = is_global
    return rows_of(slips[n_slid > 0], run.chain)


def rows_of(slips: NDArray[np.void], chain: Chain) -> NDArray[np.void]:
    """Return slip events of a chain (dtype SLIP) as rows of `slip_table` (dtype
    ROW)."""
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

    The first columns are the fields of `Slip`. The column `counted` is true if Fig. 13
    counts the event, and `front_length_m` is L_p. The last columns identify the slider:
    theta (NaN if unknown), n_blocks, normal_load_N (F_Z), slider_length_m (L) and mu_k.
    """
    return pd.DataFrame(slip_rows(run))


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
    """Return the events that Fig. 13 counts: the precursors and the first global slip.

    Events whose front is not as far as that of an earlier event are left out.
    Without a global slip, all others are returned.
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
    n_before = np.cumsum(is_global) - is_global  # global slips before each event
    return n_before == 0


def describe_light_blocks(run: Record) -> str:
    """Describe how light blocks change the number of slip events, or return ""."""
    chain = run.chain
    light = chain.bears_load & (chain.weights < LIGHT * chain.weights.mean())
    # The same transitions with zero load on light blocks, so that they are ignored.
    heavy_only = replace(chain, weights=chain.weights * ~light)
    n_all = len(slip_rows(run))
    n_heavy = len(slip_rows(replace(run, chain=heavy_only)))
    if n_all == n_heavy:
        return ""
    block = np.where(light, chain.weights, np.inf).argmin()
    effect = "keeps events from ending" if n_all < n_heavy else "has events of its own"
    return (
        f"block {block + 1}, with {chain.weights[block]:.2g} N, {effect}: "
        f"{n_all} events, {n_heavy} without light blocks"
    )
