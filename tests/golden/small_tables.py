"""The tables of the studies at a small size, made by the library's own functions,
without costs and times.

`regenerate.py` writes them to `small/`; tests compare what the functions give with what
is kept there. Runs end with the first global slip, after which errors have grown by
1e7.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache, partial
from pathlib import Path

import numpy as np
import pandas as pd
from audit.falsified import audits
from benchmark.made_up import go_on, proof_of
from settings import CONFIG
from studies.made import MAP, PAPER, study_of

from maegawa2010.paper.definitions import definitions_table
from maegawa2010.paper.scene_numbers import measures_table
from maegawa2010.studies.event_law.tables import event_law_tables
from maegawa2010.studies.larger.cycles import cycle_tables
from maegawa2010.studies.larger.first_slips import larger_tables
from maegawa2010.studies.members import gather, run_members
from maegawa2010.studies.models.tables import compare_models
from maegawa2010.studies.noise import tables as noise
from maegawa2010.studies.printed_digits.tables import digits_tables
from maegawa2010.studies.resolution import tables as resolution
from precursors import Chain, simulate
from precursors.larger.chain import LargerChain
from precursors.proof import ExactChain

AXES: list[dict[str, object]] = [
    {"key": "theta", "from": -0.95, "to": 0.95, "points": 4},
    {"key": "mu_k/mu_s", "from": 0.1, "to": 0.95, "points": 3},
]
SMALL = Path(__file__).parent / "small"
SCENES: dict[str, dict[str, str | float]] = {
    "lead": {"theta": "5/6"},
    "even": {"theta": 0.0},
}
# Times and loads of a run are right to 1e-9 s and 1e-6 N whatever the processor, and so
# are their statistics. A method with steps is off by the roundings of some 1e6 steps, a
# bisection by none or by a step of its own.
ROUNDING, STEPS = 1e-8, 1e-6
RELATIVE = dict.fromkeys(("definitions", "enclosures"), STEPS)
RELATIVE["audits"] = 1e-2  # deviations as printed, with three digits
# Errors relative to the paper's chain are differences of numbers near one.
# What the energy of a larger chain lacks is of the size of roundings in some runs.
ABSOLUTE = {"model_comparison": 1e-12, "larger_runs": 1e-12}


def definitions() -> pd.DataFrame:
    """Readings for one other size of theta, with one drop of the load."""
    slider, paper = (
        CONFIG["chain"],
        [{"events_counted": counted, "mu_sapp": 0.49} for counted in (6, 9, 14)],
    )
    runs = [
        simulate(Chain.from_slider(**slider, theta=theta), 3.0)
        for theta in ("-5/6", 0, "5/6")
    ]
    return definitions_table(runs, slider, 3.0, [0.833], [5.0], paper)


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


@cache
def studies() -> dict[str, pd.DataFrame]:
    """The tables of small studies: few runs of few blocks, with an octave and all cases
    of the law."""

    def chunks(name: str, **settings: object) -> list[pd.DataFrame]:
        return [
            run_members(study_of(name, settings)).rename_axis("member").reset_index()
        ]

    tables = noise.noise_tables(chunks("noise_members", seed=1, runs=8))
    few = chunks("resolution_members", seed=1, n_blocks=[2, 4], runs=[6, 6])
    law = chunks("event_law_members", seed=1, runs=6, n_blocks=[3, 4], middle=4)
    return {
        **tables,
        **digits_tables(chunks("digits_members", seed=1, draws=8), PAPER),
        **resolution.resolution_tables(
            few, tables["noise_members"], CONFIG["chain"], "fig10", 2
        ),
        **event_law_tables(law, CONFIG["chain"]),
        "grid": gather(chunks(MAP, axes=AXES)),
    }


def members() -> pd.DataFrame:
    """Every column of the members of each study: the sum of its squares, and its
    product with 0, 1, 2, ..."""
    settings: dict[str, dict[str, object]] = {
        "noise_members": {"seed": 1, "runs": 8},
        "digits_members": {"seed": 1, "draws": 8},
        "theta_window_members": {"window": 0.2, "points": 3},  # up to -1 and 1
        "resolution_members": {"seed": 1, "n_blocks": [2, 10, 12], "runs": [6, 9, 3]},
        "event_law_members": {"seed": 1, "runs": 6, "n_blocks": [3, 4], "middle": 4},
    }
    rows = []
    for name, own in settings.items():
        study = study_of(name, own)
        for column, values in study.members.items():
            is_text = not pd.api.types.is_numeric_dtype(values)
            numbers = values.factorize()[0] if is_text else values.to_numpy(float)
            sums = {
                "squares": numbers @ numbers,
                "in_order": numbers @ np.arange(len(numbers)),
            }
            rows.append({"study": name, "column": column, "n": len(numbers), **sums})
        rows.append(
            {
                "study": name,
                "column": "seed",
                "n": 1,
                "squares": study.seed,
                "in_order": 0.0,
            }
        )
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
                **run.larger,
            }
        )
    return pd.DataFrame(rows)


def small_larger_tables() -> dict[str, pd.DataFrame]:
    """The tables of the larger chain for a few blocks."""
    settings = CONFIG["larger"]["first_slips"] | {
        "nucleation": {
            "n_blocks": [20],
            "theta": ["-5/6", 0],
            "pairs": [[0.1, 0], [0.2, 2e-4]],
            "step": 0.25,
        },
        "studies": {
            "counts": {
                "pairs": [[0, 0], [0.2, 2e-4]],
                "n_blocks": [10],
                "normal_load": [300],
                "theta": [0, "5/6"],
                "runs": 7,
                "step": 0.25,
            },
            "height": {
                "pairs": [[0, 0]],
                "push_height": [0.005],
                "n_blocks": [4],
                "theta": [0],
                "runs": 7,
                "step": 0.01,
            },
        },
    }
    cycles = CONFIG["larger"]["cycles"] | {
        "pasts": [[0.001, 0], [0.01, 0], [0.03, 0], [0.1, 0]]
        + [[0, part / 4] for part in range(1, 5)],
        "map": {
            "length": 0.3,
            "relaxation_time": 1e-4,
            "theta": 0,
            "n_blocks": 10,
        },
        "studies": {
            "grid": {
                "pairs": [[0.3, 1e-4], [0.3, 2e-4]],
                "n_blocks": [10],
                "theta": ["-5/6", 0],
                "runs": 1,
                "step": 0.25,
            },
        },
    }
    return larger_tables(CONFIG["chain"], settings) | cycle_tables(
        CONFIG["chain"], cycles
    )


def model_comparison() -> pd.DataFrame:
    """All answers of all models, timed once."""
    return compare_models(SCENES, rounds=1)


TABLES: dict[str, Callable[[], pd.DataFrame]] = {
    "definitions": definitions,
    **{
        name: partial(lambda name: studies()[name], name)
        for name in (
            *(
                "noise",
                "noise_differences",
                "noise_amplitudes",
                "digits",
                "resolution",
                "counts_by_n",
                "resolution_limits",
            ),
            *("event_law", "grid"),
        )
    },
    "members": members,
    "measures": lambda: measures_table(
        {
            theta: simulate(Chain.from_slider(theta=theta), until="global slip")
            for theta in ("-5/6", "5/6")
        }
    ),
}
# These take seconds and are compared where other tests need them, too.
ELSEWHERE: dict[str, Callable[[], pd.DataFrame]] = {
    "audits": audits,
    "enclosures": enclosures,
    "model_comparison": model_comparison,
    "larger_runs": larger_runs,
    **{
        name: partial(lambda name: small_larger_tables()[name], name)
        for name in (
            *("larger", "larger_means", "larger_nucleation", "larger_cycles"),
            *("larger_verdicts", "larger_peaks"),
        )
    },
}


def write(table: pd.DataFrame, path: Path) -> None:
    """Keep a table, without its costs, with all digits that matter."""
    kept = table.drop(columns=[column for column in table if column.startswith("cost")])
    kept.to_csv(path, index=False, float_format="%.12g")


def assert_kept(name: str, table: pd.DataFrame) -> None:
    """The table is the one that is kept: words and counts exactly, numbers within a
    tolerance."""
    kept = pd.read_csv(SMALL / f"{name}.csv")
    found = table.drop(
        columns=[column for column in table if column.startswith("cost")]
    )
    assert list(found.columns) == list(kept.columns)
    assert len(found) == len(kept)
    for column in kept:
        if any(
            pd.api.types.is_float_dtype(numbers)
            for numbers in (found[column], kept[column])
        ):
            numbers = found[column].astype(float)
            np.testing.assert_allclose(
                numbers,
                kept[column],
                RELATIVE.get(name, ROUNDING),
                ABSOLUTE.get(name, 0.0),
                err_msg=column,
            )
        else:
            texts = [
                column_of[column].fillna("").astype(str).tolist()
                for column_of in (found, kept)
            ]
            assert texts[0] == texts[1], column
