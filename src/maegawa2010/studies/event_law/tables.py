"""A law for the number of slip events up to the first global slip.

Assumptions:

1. Block 1 begins every event, when the force on it reaches mu_s w_1.
2. The event leaves it at rest under mu_k w_1. So the drive must add (mu_s - mu_k) w_1
  until the next event.
3. At the first global slip friction is mu_k w_i everywhere: residual strain has spread
  over the chain. Then F_X = mu_k F_Z, and block 1 has moved by the compression of the
  springs, (mu_k/k) sum_i (i - 1) w_i.
4. Events take no time.

By 3 the drive has added K V t = mu_k [F_Z + (K/k) sum_i (i - 1) w_i]. By 1 and 2 the
first event takes mu_s w_1 of this, and each other one (mu_s - mu_k) w_1. So the number
of events is

    n = mu_k [F_Z - w_1 + (K/k) sum_i (i - 1) w_i] / ((mu_s - mu_k) w_1).

A soft drive (K much below E S/L) and many blocks leave n = mu_k F_Z / ((mu_s - mu_k)
w_1). The number belongs to the block: w_1 goes down as 1/N. In a real interface the
load on the length that can slip alone takes the place of w_1.

Assumption 2 is the weak one. A block that slides alone overshoots its balance: it
stops under (2 mu_k - mu_s) w_1, and the next event takes 2 (mu_s - mu_k) w_1. Waves of longer
events leave it near mu_k w_1. So there are fewer events than by the law where many
events are of one block: few blocks, or a small load at the leading edge.
"""

from collections.abc import Iterable, Iterator, Mapping
from itertools import product
from typing import Any

import numpy as np
import pandas as pd

from maegawa2010.studies.members import LOADINGS, Study, chain_of, gather, stack
from maegawa2010.support.run_statistics import NOISE
from precursors.model.chain import Chain

THETAS = (-0.9, -5 / 6, 0.0, 5 / 6, 0.95)
FRICTION = ((0.7, 0.2), (0.7, 0.3), (0.7, 0.6), (0.5, 0.45), (1.2, 0.45))
# Stiffness K of the drive [N/m]; that of the paper's slider, E S/L, is 2.5e6 N/m.
DRIVES = (0.8e4, 0.8e5, 0.8e6, 2.5e6)
# Runs last until the drive has added so many times what the law says.
MOST_LOAD = 1.5
CASE = ["varied", "loading", "theta", "n_blocks", "mu_s", "mu_k", "drive_stiffness"]


def added_load(chain: Chain) -> float:
    """Load K V t [N] that the drive has added when friction is mu_k w_i everywhere."""
    compression = np.sum(np.arange(chain.n_blocks) * chain.weights) / chain.stiffness
    return chain.mu_k * (chain.normal_load + chain.drive_stiffness * compression)


def predicted_events(chain: Chain) -> float:
    """Number of slip events up to the first global slip."""
    w_1 = chain.weights[0]
    return float(
        (added_load(chain) - chain.mu_k * w_1) / ((chain.mu_s - chain.mu_k) * w_1)
    )


def event_law_study(slider: Mapping[str, Any], settings: Mapping[str, Any]) -> Study:
    """Chains on which the law is tested: N and theta; friction; stiffness of the drive;
    shape of the load."""
    blocks = []
    for group, case in enumerate(_cases(settings)):
        member = {
            "theta": 0.0,
            **slider,
            "loading": "linear",
            "load_noise": NOISE,
            **case,
        }
        chain = chain_of(member | {"load_noise": 0.0})
        duration = MOST_LOAD * added_load(chain) / chain.loading_rate
        draws = {
            "group": group,
            "draw": np.arange(settings["runs"]),
            "duration": duration,
        }
        blocks.append(member | draws)
    return Study(stack(blocks), seed=settings["seed"])


def _cases(settings: Mapping[str, Any]) -> Iterator[dict[str, Any]]:
    numbers = settings["n_blocks"]
    middle = settings["middle"]
    for theta, n in product(THETAS, numbers):
        yield {"varied": "n_and_theta", "theta": theta, "n_blocks": n}
    for mu_s, mu_k in FRICTION:
        yield {"varied": "friction", "n_blocks": middle, "mu_s": mu_s, "mu_k": mu_k}
    for stiffness in DRIVES:
        yield {"varied": "drive", "n_blocks": middle, "drive_stiffness": stiffness}
    for loading, n in product(LOADINGS, sorted({numbers[1], middle, numbers[-1]})):
        yield {"varied": "loading", "n_blocks": n, "loading": loading}


def event_law_tables(
    chunks: Iterable[pd.DataFrame], slider: Mapping[str, Any]
) -> dict[str, pd.DataFrame]:
    """The tables of the study, by file name."""
    members = gather(chunks)
    return {"event_law_members": members, "event_law": event_law_table(members, slider)}


def event_law_table(members: pd.DataFrame, slider: Mapping[str, Any]) -> pd.DataFrame:
    """The law beside the runs, a row for each chain: medians over the runs with a
    global slip, of the events and of their ratio to the law."""
    members = members.assign(
        **{name: slider[name] for name in set(slider) - set(members)}
    )
    rows = []
    for case, runs in members.groupby(CASE, sort=False):
        chain = chain_of(runs.iloc[0].to_dict() | {"load_noise": 0.0})
        events = runs.loc[runs["reached"], "events_to_global_slip"]
        predicted = predicted_events(chain)
        found = {
            "predicted_events": predicted,
            "n_runs": len(runs),
            "events_to_global_slip": events.median(),
            "ratio": events.median() / predicted,
        }
        rows.append(dict(zip(CASE, case, strict=True)) | found)
    return pd.DataFrame(rows)
