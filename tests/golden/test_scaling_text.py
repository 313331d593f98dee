"""docs/scaling.md quotes what was measured and what follows from it.

`snakemake -c1 results/tables/scaling.csv` measures anew, some two minutes with nothing else running; its
scaling.csv and scaling_maps.csv then replace the two golden files, and its scaling.md the tables of the text.
"""

from __future__ import annotations

from pathlib import Path

import pandas as pd
import pytest
import yaml
from golden.regenerate import GOLDEN

from precursors.ensembles.scaling import time_of_maps
from precursors.ensembles.scaling_text import scaling_text

ROOT = Path(__file__).parents[2]
COSTS, MAPS = GOLDEN / "scaling.csv", GOLDEN / "scaling_maps.csv"


@pytest.mark.parametrize("passage", range(4))
def test_the_text_has_the_numbers_of_the_tables(passage):
    text = (ROOT / "docs/scaling.md").read_text(encoding="utf-8")
    assert scaling_text(pd.read_csv(COSTS), pd.read_csv(MAPS))[passage] in text


def test_the_cost_of_large_maps_follows_from_the_measured_times():
    costs, maps = pd.read_csv(COSTS), pd.read_csv(MAPS)
    timed = costs[costs["kind"] == "map"]
    settings = yaml.safe_load((ROOT / "config.yaml").read_text(encoding="utf-8"))["scaling"]
    again = time_of_maps(
        dict(zip(timed["case"], timed["seconds_per_run"], strict=True)),
        settings["points"],
        settings["cores"],
        settings["seconds_per_job"],
    )
    pd.testing.assert_frame_equal(again, maps)
