"""Misprints of the paper, and points that it leaves open beside the readings of definitions.csv."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike

from precursors.model import printed
from precursors.model.chain import linear_weights, theta_from_load_cells
from precursors.reproduction import eq15
from precursors.reproduction.claim import shown
from precursors.reproduction.inputs import SCENES, UNIFORM
from precursors.reproduction.tables import Tables, before_global, one, rows

MISPRINT, OPEN = "misprint", "open point"


@dataclass(frozen=True)
class Point:
    """What the paper prints, what is meant or taken instead, and a number with each of the two."""

    section: str
    kind: str
    as_printed: str
    taken: str
    numbers: Callable[[Tables], tuple[ArrayLike, ArrayLike]] = lambda _: ((), ())
    unit: str = "1"


def eq12(t: Tables) -> tuple[ArrayLike, ArrayLike]:
    """F_X of the state of Eq. 12."""
    checks = (eq15.AS_PRINTED, eq15.AT_REST)
    as_printed, right = ([float(one(t["eq15"], "found", check=c, case=s)) for s in SCENES] for c in checks)
    return as_printed, right


def counts(t: Tables) -> list[int]:
    """Events of Fig. 13, the first global slip included."""
    return [int(t[f"{scene}_slips"]["counted"].sum()) for scene in SCENES]


def residual_strain(t: Tables) -> tuple[ArrayLike, ArrayLike]:
    """mu_sapp from the largest residual strain, and from natural length."""
    most = [float(one(t["eq15"], "found", check=eq15.FULL_STRAIN, case=scene)) for scene in SCENES]
    return most, [one(t["mu_sapp"], "mu_sapp", scene=scene, is_papers=True) for scene in SCENES]


def short_events(t: Tables) -> tuple[ArrayLike, ArrayLike]:
    """Short events, which the experiment does not have."""
    return 0, [len(rows(before_global(t, scene), counted=False)) for scene in SCENES]


def slider(t: Tables, column: str) -> float:
    """A column of the slider, the same in all scenes."""
    return float(t[f"{UNIFORM}_slips"][column].iloc[0])


def theta_of_cells(t: Tables) -> float:
    """theta of the straight line through the load cells of Fig. 7."""
    return theta_from_load_cells(*printed.CELL_LOADS_N, printed.CELL_SPACING_M, slider(t, "length_m"))


def cell_moment(t: Tables) -> float:
    """Moment of the loads of the cells about the middle of the contact, over F_Z L."""
    low, high = printed.CELL_LOADS_N
    return (high - low) / (high + low) * printed.CELL_SPACING_M / 2 / slider(t, "length_m")


def ratio_at_cells(t: Tables) -> tuple[ArrayLike, ArrayLike]:
    """Ratio of the normal loads at the load cells."""
    theta, n = theta_of_cells(t), slider(t, "n_blocks")
    there = theta * (printed.CELL_SPACING_M / slider(t, "length_m")) / (1 - 1 / n)
    return (1 + there) / (1 - there), printed.CELL_LOADS_N[1] / printed.CELL_LOADS_N[0]


def theta_by_moments(t: Tables) -> tuple[ArrayLike, ArrayLike]:
    """theta by moments with ten blocks, and with a line contact, against that of the straight line."""
    n = int(slider(t, "n_blocks"))
    centres = (np.arange(n) + 0.5) / n - 0.5
    blocks = float(linear_weights(n, 1.0, 1.0) @ centres)
    return [cell_moment(t) / blocks, cell_moment(t) / (1 / 6)], theta_of_cells(t)


def end_to_end(t: Tables) -> tuple[ArrayLike, ArrayLike]:
    """Stiffness of the slider from end to end."""
    n, k = slider(t, "n_blocks"), one(t["measures"], "stiffness_N_per_m", scene=UNIFORM)
    return k / (n - 1), k / n


POINTS = (
    Point(
        "Sect. 6.2, Eq. 12",
        MISPRINT,
        "K y_N in the last line (our text was read by a machine, which may have made a K of a k)",
        "k y_N (F_X of the state of Eq. 12)",
        eq12,
        "N",
    ),
    Point(
        "Fig. 8, caption",
        MISPRINT,
        "uniform loading for the open circles (theta)",
        "non-uniform loading, F_ZA = 100 N and F_ZB = 300 N",
        lambda t: (0, theta_of_cells(t)),
    ),
    Point(
        "Sect. 5.2",
        MISPRINT,
        "the latter figure, which is Fig. 8, leaves short events out",
        "Fig. 13 does; the experiment has none (short events)",
        short_events,
    ),
    Point("Eqs. 1 and 5", MISPRINT, "mu_app and f_max", "mu_sapp and f_smax, as elsewhere"),
    Point(
        "Abstract and Sect. 7 (4)",
        OPEN,
        "mu_sapp is below mu_s due to the residual strain (mu_sapp from the largest residual strain)",
        "as in Sect. 6.2: because the strain is not at its largest (mu_sapp from natural length)",
        residual_strain,
    ),
    Point(
        "Sects. 3.2.2, 5.2 and 6.1",
        OPEN,
        "counts of experiment and simulation are similar; how near is not said (experiment)",
        "no verdict (simulation)",
        lambda t: (list(printed.EVENTS_OF_EXPERIMENT.values()), counts(t)),
    ),
    Point(
        "Sects. 3.2.2 and 5.2",
        OPEN,
        "number of precursors, which a global slip is not",
        "the global slip is counted, as the paper says (events in Fig. 13)",
        lambda t: (np.subtract(counts(t), 1), counts(t)),
    ),
    Point(
        "Figs. 10-12",
        OPEN,
        "our text of the paper does not say what time the figures span",
        "a time that holds the first global slip",
    ),
    Point(
        "Eq. 7 and Sect. 5.2",
        OPEN,
        "1 -+ theta at the outer blocks; theta of the line through the cells (ratio of loads at the cells)",
        "the loads of the cells",
        ratio_at_cells,
    ),
    Point(
        "Eq. 7 and Sect. 5.2",
        OPEN,
        "theta may balance the moments of the cells: ten blocks, or a line contact (theta)",
        "the straight line through the cells",
        theta_by_moments,
    ),
    Point(
        "Eq. 7 and Sect. 6.2",
        OPEN,
        "0/0 for N = 1",
        "the block has the whole normal load (w_1)",
        lambda t: (np.nan, linear_weights(1, slider(t, "normal_load_N"), 0.0)),
        "N",
    ),
    Point(
        "Eq. 10",
        OPEN,
        "N blocks with springs k = N E S/L have N - 1 springs between them",
        "E S/L (stiffness of the slider from end to end)",
        end_to_end,
        "N/m",
    ),
)


def open_points_table(tables: Tables) -> pd.DataFrame:
    """One row per point: section, kind, as_printed, taken, unit, number_as_printed, number_taken."""
    table = pd.DataFrame(POINTS).drop(columns="numbers")
    numbers = [[shown(values) for values in point.numbers(tables)] for point in POINTS]
    return table.join(pd.DataFrame(numbers, columns=["number_as_printed", "number_taken"]))
