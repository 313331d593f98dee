"""Runs made up for tests by hand."""

import pandas as pd


def runs_of(events_counted: list[int], **mu_sapp: list[float]) -> pd.DataFrame:
    """Runs of scenes with these mu_sapp, NaN for a run without a global slip; draw 0 is
    the scene."""
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
