"""The paper's numbers for random sliders whose inputs round to the printed ones:
mu_s = 0.70 stands for any value from 0.695 to 0.705."""

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np
import pandas as pd

from maegawa2010.studies.members import TOLERANCES, Study, gather, stack
from maegawa2010.support.run_statistics import nine_tenths, share_interval

# Half a unit of the last printed digit (Sect. 4 and the captions of Figs. 10-12), in SI
# units. F_Z is left out because it only scales all forces. S and L are left out because
# they act only through k, which E varies.
HALF_A_DIGIT = {
    "mu_s": 0.005,
    "mu_k": 0.005,
    "drive_stiffness": 0.05e6,
    "drive_velocity": 0.05e-3,
    "slider_mass": 0.0005,
    "youngs_modulus": 0.05e9,
    "theta": 0.0005,
}
THETA_DIGITS = 3
ALL = "all"


def digits_study(
    sliders: Mapping[str, Mapping[str, Any]],
    duration: float,
    settings: Mapping[str, Any],
) -> Study:
    """Random sliders with the same printed inputs. Draw i is the same slider in each
    scene; draw 0 is the scene itself."""
    random = np.random.default_rng(settings["seed"])
    changes = {
        key: half * random.uniform(-1, 1, settings["draws"])
        for key, half in HALF_A_DIGIT.items()
    }
    blocks = []
    for scene, slider in sliders.items():
        printed = {**slider, "theta": round(slider["theta"], THETA_DIGITS)}
        changed = {
            key: np.append(slider[key], printed[key] + change)
            for key, change in changes.items()
        }
        # A slower drive takes longer to reach the same load.
        slowest = 1 - HALF_A_DIGIT["drive_velocity"] / slider["drive_velocity"]
        labels = {
            "scene": scene,
            "draw": np.arange(settings["draws"] + 1),
            "duration": duration / slowest,
        }
        blocks.append({**slider, **changed, **labels})
    return Study(stack(blocks), seed=settings["seed"])


def digits_tables(
    chunks: Iterable[pd.DataFrame], paper: Mapping[str, Mapping[str, float]]
) -> dict[str, pd.DataFrame]:
    """The tables of the study, by file name."""
    members = gather(chunks)
    return {"digits_members": members, "digits": digits_table(members, paper)}


def digits_table(
    members: pd.DataFrame, paper: Mapping[str, Mapping[str, float]]
) -> pd.DataFrame:
    """How often sliders with the same printed inputs have the paper's numbers.

    `paper` has events_counted and mu_sapp of each scene, where the paper prints them.

    Returns
    -------
    DataFrame
        One row per scene, quantity and question. The answer is yes for k of n sliders;
        their share has an interval from low to high. Question as_printed: does a slider
        have the paper's value? q05, q50 and q95 are quantiles of the quantity. Scene all
        has two questions. all_six: are all six numbers the paper's? same_mu_sapp: do the
        three mu_sapp of a slider agree to one unit of the last digit? The quantiles are
        then those of their largest difference.
    """
    draws = members[members["draw"] > 0].pivot_table(
        index="draw", columns="scene", dropna=False
    )
    rows = []
    six = []
    for scene, values in paper.items():
        for quantity, value in values.items():
            drawn = draws[quantity, scene]
            agree = (drawn - value).abs() <= TOLERANCES[quantity]
            six.append(agree)
            names = {"scene": scene, "quantity": quantity, "question": "as_printed"}
            rows.append(
                names | {"value": value} | share_row(agree) | nine_tenths(drawn)
            )
    friction: Any = draws["mu_sapp"]
    span = friction.max(axis=1, skipna=False) - friction.min(axis=1, skipna=False)
    same = span <= TOLERANCES["mu_sapp"]
    names = {"scene": ALL, "quantity": "mu_sapp", "question": "same_mu_sapp"}
    rows.append(names | {"value": span.median()} | share_row(same) | nine_tenths(span))
    if six:
        names = {"scene": ALL, "quantity": ALL, "question": "all_six"}
        together = pd.concat(six, axis=1).all(axis=1)
        rows.append(names | {"value": len(six)} | share_row(together))
    return pd.DataFrame(rows)


def share_row(hits: pd.Series) -> dict[str, Any]:
    """Number of hits, and their share with its interval."""
    k = int(hits.sum())
    n = len(hits)
    low, high = share_interval(k, n)
    return {"k": k, "n": n, "share": k / n, "low": low, "high": high}
