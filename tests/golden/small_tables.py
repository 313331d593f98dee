"""Small tables of runs that take seconds: compared where other tests need them, too."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import pandas as pd
from settings import CONFIG

from maegawa2010.studies.larger.cycles import (
    run_settled,
    settled_study,
    settled_table,
)
from maegawa2010.studies.larger.first_slips import larger_tables
from maegawa2010.studies.models.tables import compare_models
from precursors import Chain, simulate
from precursors.larger.chain import LargerChain

SCENES: dict[str, dict[str, str | float]] = {
    "lead": {"theta": "5/6"},
    "even": {"theta": 0.0},
}

# Of a chain with a length.
STUDY = {"even_length": [0.3], "relaxation_time": [2e-4], "theta": ["-5/6", 0]}


def larger_runs() -> pd.DataFrame:
    """Short runs of larger chains: blocks, theta, what is added, duration; where they
    end, and their sums."""
    cases = [
        (20, 0, {"weakening_velocity": 0.035}, 0.6),
        (
            8,
            "-5/6",
            {"weakening_velocity": 0.01, "relaxation_time": 5e-6, "push_height": 0.003},
            3.0,
        ),
        (10, 0, {"weakening_velocity": 0.006, "relaxation_time": 1e-4}, 3.5),
        (12, "-1/2", {"weakening_velocity": 0.07, "viscosity": 100.0}, 0.8),
        (6, "5/6", {"viscosity": 50.0}, 2.2),
        (5, "1/3", {"push_height": 0.003}, 2.5),
        (4, 0, {}, 3.0),
        (1, 0, {"weakening_velocity": 0.02, "push_height": 0.003}, 8.0),
    ]
    rows = []
    for n, theta, added, duration in cases:
        chain = Chain.from_slider(n_blocks=n, theta=theta)
        run = simulate(LargerChain(chain, **added), duration)
        sums = {
            name: run.transitions[name].astype(float).sum()
            for name in run.transitions.dtype.names or ()
        }
        points = {"points": len(run.load_points), "of_points": run.load_points.sum()}
        rows.append(
            {
                "transitions": len(run.transitions),
                **sums,
                **points,
                **run.numbers,
            }
        )
    return pd.DataFrame(rows)


def small_larger_tables() -> dict[str, pd.DataFrame]:
    """The tables of the larger chain for a few blocks."""
    first = CONFIG["larger"]["first_slips"] | {
        "nucleation": STUDY | {"n_blocks": [20]},
        "studies": {
            "counts": STUDY | {"n_blocks": [10], "runs": 7},
            "height": STUDY
            | {"even_length": [0], "relaxation_time": [0], "push_height": [0.005]}
            | {"n_blocks": [4], "runs": 7, "step": 0.01},
        },
    }
    pasts = {"pasts": [[0.1, 0], [0, 0.5]], "step": 0.5}
    settled = CONFIG["larger"]["settled"] | {
        "studies": {"map": STUDY | pasts | {"n_blocks": [16]}},
        "drawn": [],
    }
    members = run_settled(settled_study(CONFIG["chain"], settled))
    chunk = members.rename_axis("member").reset_index()
    return larger_tables(CONFIG["chain"], first) | {
        "larger_settled": settled_table([chunk])
    }


def model_comparison() -> pd.DataFrame:
    """All answers of all models, timed once."""
    return compare_models(SCENES, rounds=1)


TABLES_OF_SECONDS: dict[str, Callable[[], pd.DataFrame]] = {
    "model_comparison": model_comparison,
    "larger_runs": larger_runs,
    **{
        name: partial(lambda name: small_larger_tables()[name], name)
        for name in (
            "larger",
            "larger_nucleation",
            "larger_settled",
        )
    },
}
