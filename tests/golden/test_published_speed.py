"""The comparison of methods, published and made anew.

`snakemake -c2 --configfile config.yaml workflow/full.yaml -- accuracy` measures anew,
some ten minutes with nothing else running; its table and speed.png drawn from it then
replace paper/tables/work_precision_full.csv and the golden chart.
"""

from __future__ import annotations

from pathlib import Path

import pytest
from golden.regenerate import GOLDEN

from precursors.support.files import read_table

TABLE = GOLDEN.parents[1] / "paper/tables/work_precision_full.csv"
MADE = Path(__file__).parents[2] / "results/tables/work_precision.csv"


@pytest.fixture(scope="module", params=[TABLE, MADE], ids=["published", "made"])
def table(request):
    return read_table(request.param)


def test_every_method_that_comes_as_close_as_the_exact_solver_takes_longer(table):
    assert set(table["scene"]) == {"uniform"}
    is_right = table["transitions_right"].eq(table["transitions_true"])
    (exact,) = table[is_right & table["method"].eq("exact")].to_dict("records")
    whole = table[is_right & table["method"].ne("exact")]
    as_close = whole[whole["time_error_s"] <= exact["time_error_s"]]
    assert (as_close["seconds"] > exact["seconds"]).all()
    assert set(as_close["method"]) <= {"heyoka"}
