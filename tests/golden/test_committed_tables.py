"""The committed table of a long study: its short rows are computed again."""

from pathlib import Path

import pandas as pd
from settings import CONFIG, FULL, SLIDERS

from maegawa2010.studies.members import noise_table, run_members
from maegawa2010.studies.resolution.tables import (
    POINT,
    QUANTITIES,
    resolution_study,
)

ROOT = Path(__file__).parents[2]


def committed(name: str) -> pd.DataFrame:
    return pd.read_csv(ROOT / f"paper/tables/{name}.csv")


def test_medians_with_twenty_blocks_are_those_of_the_library():
    settings = CONFIG["resolution"] | FULL["resolution"]
    study = resolution_study(SLIDERS, CONFIG["duration"], settings)
    few = study.members[study.members["n_blocks"] == 20]
    runs = run_members(type(study)(few, seed=study.seed))
    again = noise_table(runs, POINT, QUANTITIES)
    there = committed("resolution_full").merge(again[[*POINT, "quantity"]])
    pd.testing.assert_frame_equal(there, again, rtol=1e-6)
