"""Small tables of runs that take seconds: compared where other tests need them, too."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import pandas as pd
from audit.falsified import audits
from benchmark.made_up import go_on, proof_of
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
from precursors.proof import ExactChain

SCENES: dict[str, dict[str, str | float]] = {
    "lead": {"theta": "5/6"},
    "even": {"theta": 0.0},
}

# Of a chain with a length.
STUDY = {"even_length": [0.3], "relaxation_time": [2e-4], "theta": ["-5/6", 0]}

# Chain, start [m, m/s], and number of transitions.
PROVED = {
    "falling loads": (ExactChain.from_slider(theta="-5/6"), [0] * 10, [0] * 10, 60),
    "one block": (ExactChain.from_slider(n_blocks=1), [0], [0], 8),
    "stiff drive": (
        ExactChain.from_slider(n_blocks=3, drive_stiffness="3e7", mu_k="0.1"),
        [0] * 3,
        [0] * 3,
        24,
    ),
    "moving, overloaded": (
        ExactChain.from_slider(n_blocks=4, theta="1/3"),
        ["0", "0", "2e-6", "-1.1e-5"],
        ["-1e-3", "2e-3", "0", "0"],
        30,
    ),
}


def enclosures() -> pd.DataFrame:
    """How a proof of 128 bits goes on: steps, modes, radii of times and loads, the
    distance and the gap."""
    rows = []
    for name, (chain, positions, velocities, n) in PROVED.items():
        proof = proof_of(chain, 128, positions, velocities)
        steps, done = 0, 0
        while done < n:
            for transition in proof.transitions[done:]:
                ball, load = transition.time, transition.tangential_load
                rows.append(
                    {
                        "chain": name,
                        "steps": steps,
                        "block": transition.block,
                        "mode": transition.mode,
                        "fresh": str(sorted(proof.fresh)),
                        "bits": proof.precision(),
                        "time_s": float(ball.mid()),
                        "load_N": float(load.mid()),
                        "time_radius_s": float(ball.rad()),
                        "load_radius_N": float(load.rad()),
                        "distance_N": float(proof.state.distance),
                        "gap_T": float(proof.gap),
                    }
                )
            done = len(proof.transitions)
            steps += 1
            go_on(proof)
    return pd.DataFrame(rows)


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
    "audits": audits,
    "enclosures": enclosures,
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
