"""The committed tables of long studies: the law, the shares and the short rows in them
are computed again."""

from pathlib import Path

import pandas as pd
import pytest
from settings import CONFIG, FULL, SLIDERS

from maegawa2010.studies.event_law.tables import (
    event_law_study,
    event_law_table,
    predicted_events,
)
from maegawa2010.studies.members import chain_of, noise_table, run_members
from maegawa2010.studies.resolution.tables import (
    POINT,
    QUANTITIES,
    resolution_study,
)

ROOT = Path(__file__).parents[2]
# Tables are written with all digits; sums differ by roundings.
ROUNDING = 1e-12


def committed(name: str) -> pd.DataFrame:
    return pd.read_csv(ROOT / f"paper/tables/{name}.csv")


def test_the_law_of_each_chain_is_that_of_the_library():
    """No median exceeds it by a tenth."""
    for row in committed("event_law_full").to_dict("records"):
        chain = chain_of({**CONFIG["chain"], **row})
        assert row["predicted_events"] == pytest.approx(
            predicted_events(chain), rel=ROUNDING
        )
        assert row["ratio"] < 1.1


def test_the_runs_of_few_blocks_are_those_of_the_library():
    study = event_law_study(CONFIG["chain"], CONFIG["event_law"])
    few = study.members[
        (study.members["n_blocks"] <= 10) & (study.members["theta"] == 0.0)
    ]
    again = event_law_table(
        run_members(type(study)(few, seed=study.seed)), CONFIG["chain"]
    )
    assert len(again) > 1
    keys = ["varied", "loading", "theta", "n_blocks"]
    there = committed("event_law_full").merge(again[keys], on=keys)
    pd.testing.assert_frame_equal(there, again, rtol=1e-6)


def test_medians_with_twenty_blocks_are_those_of_the_library():
    settings = CONFIG["resolution"] | FULL["resolution"]
    study = resolution_study(SLIDERS, CONFIG["duration"], settings)
    few = study.members[study.members["n_blocks"] == 20]
    runs = run_members(type(study)(few, seed=study.seed))
    again = noise_table(runs, POINT, QUANTITIES)
    there = committed("resolution_full").merge(again[[*POINT, "quantity"]])
    pd.testing.assert_frame_equal(there, again, rtol=1e-6)
