"""Slip events of a run as tables, and those that Fig. 13 counts."""

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike, NDArray

from precursors.analysis.events import SLIP, slip_events
from precursors.solver.run import Record

# Columns of `slip_table` that say which slider it was, and its attributes.
OF_SLIDER = {
    "theta": "theta",
    "n_blocks": "n_blocks",
    "normal_load_N": "normal_load",
    "slider_length_m": "length",
    "mu_k": "mu_k",
}


def find_slips(run: Record) -> pd.DataFrame:
    """Slip events of a run: maximal time intervals in which at least one block slides.

    Returns
    -------
    DataFrame
        One row per event: onset, end [s], load_before, load_after (F_X at onset and
        end), largest_load (F_X up to the onset) [N], front (farthest block that slid,
        1..N), n_slid (blocks that slid at some time), n_simultaneous (most blocks that
        slid at the same instant), is_global (all N at the same instant). The event that
        the end of the run cuts off has end and load_after NaN.
    """
    slips = pd.DataFrame(slip_events(run))
    return slips.rename(columns=lambda name: name.removesuffix("_s").removesuffix("_N"))


def slip_table(run: Record) -> pd.DataFrame:
    """Every slip event of a run, with units in the names of the columns.

    They are those of `find_slips`, and: counted, the rows of Fig. 13;
    front_length_m (L_p). theta, n_blocks, normal_load_N (F_Z), slider_length_m
    (L) and mu_k say which slider it was, the same in every row; theta is NaN where it
    is not known.
    """
    slips = slip_events(run)
    columns = {name: slips[name] for name in SLIP.names or ()}
    columns["counted"] = counted(slips)
    columns["front_length_m"] = slips["front"] * run.chain.length / run.chain.n_blocks
    for column, name in OF_SLIDER.items():
        columns[column] = np.full(len(slips), getattr(run.chain, name))
    return pd.DataFrame(columns)


def find_precursors(slips: pd.DataFrame) -> pd.DataFrame:
    """Events of Fig. 13: short ones left out, up to and including the first global
    slip.

    An event is short if its front is strictly less than the farthest front before it;
    equal ones are counted. Without a global slip all events that are not short are
    returned.
    """
    return slips[counted(slips)]


def counted(slips: pd.DataFrame | NDArray[np.void]) -> NDArray[np.bool_]:
    """Which events Fig. 13 counts: see `find_precursors`."""
    front = np.asarray(slips["front"])
    is_short = front < np.maximum.accumulate(front)
    return until_global(slips["is_global"]) & ~is_short


def until_global(is_global: ArrayLike) -> NDArray[np.bool_]:
    """Which events come up to and including the first global slip."""
    is_global = np.asarray(is_global, bool)
    return np.cumsum(is_global) - is_global == 0
