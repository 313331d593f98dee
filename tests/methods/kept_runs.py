"""Short runs of every method, kept in `golden/small/methods.csv`: what they cost and
where they switch."""

from __future__ import annotations

import numpy as np
import pandas as pd

from maegawa2010.methods import METHODS
from precursors import Chain

# A drive so fast makes slips follow one another within milliseconds.
SPEED = 0.01  # m/s
# A chain, a duration [s] and where the run ends. Blocks are released backward and turn
# round; one block slides for more steps than a leg has; the first slip is not global;
# fronts are of all lengths.
RUNS: dict[str, tuple[Chain, float, str | None]] = {
    "backward": (
        Chain.from_slider(n_blocks=3, theta="-5/6", mu_k=0.1, drive_velocity=SPEED),
        0.0235,
        None,
    ),
    "one block": (
        Chain.from_slider(n_blocks=1, drive_velocity=SPEED),
        0.1,
        "global slip",
    ),
    "two blocks": (
        Chain.from_slider(n_blocks=2, drive_velocity=SPEED),
        0.1,
        "global slip",
    ),
    "ten blocks": (Chain.from_slider(theta="5/6", drive_velocity=SPEED), 0.007, None),
}
# Values by what the setting is, or by the method where these are too coarse, too slow
# or hang on rounding.
SETTINGS = {
    "none": (0.0,),
    "step [s]": (5e-6, 1e-6, 1e-7),
    "relative tolerance": (1e-4, 1e-8),
    "rk4_located": (5e-6, 1e-6),
}


def kept_runs(method: str) -> pd.DataFrame:
    """A row per run and value: its cost, its transitions, and means that depend on all
    of them."""
    rows = []
    for name, (chain, duration, until) in RUNS.items():
        for value in SETTINGS.get(method) or SETTINGS[METHODS[method].setting]:
            run, evaluations = vars(
                METHODS[method].solve(chain, duration, value, until)
            ).values()
            rows.append(
                {
                    "method": method,
                    "run": name,
                    "value": value,
                    "evaluations": evaluations,
                    "modes": "".join("o+-"[mode] for mode in run.transitions["mode"]),
                    "blocks": run.transitions["block"].sum(),
                    "end": run.duration,
                    "time": np.append(run.transitions["time"], run.duration).mean(),
                    "load": np.append(run.transitions["tangential_load"], 0.0).mean(),
                }
            )
    return pd.DataFrame(rows)
