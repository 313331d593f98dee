"""Tables of made-up runs."""

import pandas as pd


def runs_of(events_counted: list[int], **mu_sapp: list[float]) -> pd.DataFrame:
    """Runs with given mu_sapp by scene, NaN without a global slip; draw 0 is the scene
    itself."""
    draws = {"draw": range(len(events_counted)), "events_counted": events_counted}
    same = {
        "theta": 0.0,
        "n_blocks": 10,
        "events_to_global_slip": 4,
        "global_slip_s": 2.0,
    }
    tables = [
        pd.DataFrame({"scene": scene, **draws, **same, "mu_sapp": mu})
        for scene, mu in mu_sapp.items()
    ]
    members = pd.concat(tables, ignore_index=True)
    return members.assign(reached=members["mu_sapp"].notna())
