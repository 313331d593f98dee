"""Misprints of the paper, and open points that are not readings in definitions.csv."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike

from maegawa2010 import printed
from maegawa2010.paper.claim import shown
from maegawa2010.paper.inputs import LEADING, SCENES, UNIFORM
from maegawa2010.paper.tables import Tables, before_global, cell, rows
from precursors.model.chain import linear_weights
from precursors.support.files import read_table

# The paper's number, as printed or meant, and ours.
Pair = tuple[ArrayLike, ArrayLike]


def of_check(t: Tables, check: str) -> list[float]:
    """Our value in a check of Eq. 15, for each scene."""
    return [float(cell(t["eq15"], "computed", check=check, case=s)) for s in SCENES]


def eq12(t: Tables) -> Pair:
    """F_X in the state of Eq. 12."""
    return of_check(t, "as_printed"), of_check(t, "at_rest")


def events_counted(t: Tables) -> list[int]:
    """Events of Fig. 13, including the first global slip."""
    return [int(t[f"{scene}_slips"]["counted"].sum()) for scene in SCENES]


def residual_strain(t: Tables) -> Pair:
    """mu_sapp of a run from the largest residual strain, and from natural length."""
    return of_check(t, "full_strain"), [
        cell(t["reproduction"], "reproduced", scene=scene, quantity="mu_sapp")
        for scene in SCENES
    ]


def short_events(t: Tables) -> Pair:
    """Short events; the experiment has none."""
    return 0, [len(rows(before_global(t, scene), counted=False)) for scene in SCENES]


def slider(t: Tables, column: str, scene: str = UNIFORM) -> float:
    """A parameter of the slider, from a column that is constant in a scene."""
    return float(t[f"{scene}_slips"][column].unique().item())


def difference_of_cells() -> float:
    """Difference between the loads of the two load cells, over F_Z."""
    low, high = printed.CELL_LOADS_N
    return (high - low) / (high + low)


def ratio_at_cells(t: Tables) -> Pair:
    """Ratio of the normal loads at the two load cells."""
    there = difference_of_cells() / (1 - 1 / slider(t, "n_blocks"))
    return (1 + there) / (1 - there), printed.CELL_LOADS_N[1] / printed.CELL_LOADS_N[0]


def theta_by_moments(t: Tables) -> Pair:
    """theta from the balance of moments, with ten blocks and with a line contact, and
    the paper's theta from a straight line through the loads of the cells."""
    # Moments about the middle of the contact over F_Z L: of the cells' loads, and of the
    # blocks' loads with theta = 1.
    cells = (
        difference_of_cells()
        * printed.CELL_SPACING_M
        / slider(t, "slider_length_m")
        / 2
    )
    n = int(slider(t, "n_blocks"))
    blocks = float(linear_weights(n, 1.0, 1.0) @ ((np.arange(n) + 0.5) / n - 0.5))
    return [cells / blocks, cells / (1 / 6)], slider(t, "theta", LEADING)


def end_to_end(t: Tables) -> Pair:
    """Stiffness of the slider from end to end."""
    n = slider(t, "n_blocks")
    k = cell(t["measures"], "stiffness_N_per_m", scene=UNIFORM)
    return k / (n - 1), k / n


# Numbers of each point. The parentheses in open_points.csv say what the numbers are.
NUMBERS: dict[str, Callable[[Tables], Pair]] = {
    "eq12": eq12,
    "fig8": lambda t: (0, slider(t, "theta", LEADING)),
    "short_events": short_events,
    "residual_strain": residual_strain,
    "counts": lambda t: (
        list(printed.EVENTS_OF_EXPERIMENT.values()),
        events_counted(t),
    ),
    "precursors": lambda t: (np.subtract(events_counted(t), 1), events_counted(t)),
    "ratio_at_the_cells": ratio_at_cells,
    "moments": theta_by_moments,
    "one_block": lambda t: (np.nan, linear_weights(1, slider(t, "normal_load_N"), 0.0)),
    "end_to_end": end_to_end,
}


def open_points_table(tables: Tables) -> pd.DataFrame:
    """One row per point: point, section, kind, as_printed, taken, unit,
    number_as_printed, number_taken."""
    table = read_table(Path(__file__).with_name("open_points.csv"), dtype=str)
    pairs = [
        NUMBERS[point](tables) if point in NUMBERS else ((), ())
        for point in table["point"]
    ]
    numbers = [[shown(values) for values in pair] for pair in pairs]
    table[["number_as_printed", "number_taken"]] = numbers
    return table
