"""Fast rows of the committed table of a long study are computed again."""

import pandas as pd
from places import made
from settings import CONFIG, FULL, SLIDERS

from maegawa2010.studies.members import noise_table
from maegawa2010.studies.resolution.tables import resolution_study
from maegawa2010.studies.runs import run_members


def test_committed_medians_with_twenty_blocks_are_reproduced():
    settings = CONFIG["resolution"] | FULL["resolution"]
    study = resolution_study(SLIDERS, CONFIG["duration"], settings)
    few = study.members[study.members["n_blocks"] == 20]
    runs = run_members(type(study)(few, seed=study.seed))
    row = ["scene", "theta", "n_blocks", "quantity"]
    again = noise_table(runs).set_index(row)
    there = made("resolution").set_index(row).loc[again.index, again.columns]
    pd.testing.assert_frame_equal(there, again, rtol=1e-6)
