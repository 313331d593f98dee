"""The comparison of methods, published and made anew: tables say what is said of them,
a chart shows one.

`snakemake -c2 --configfile config.yaml workflow/full.yaml -- accuracy` measures anew,
some ten minutes with nothing else running; its table and speed.png drawn from it then
replace paper/tables/work_precision_full.csv and the golden chart.
"""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from golden.regenerate import GOLDEN

from maegawa2010.studies.work_precision import figure as speed
from precursors.support.files import read_table

TABLE = GOLDEN.parents[1] / "paper/tables/work_precision_full.csv"
MADE = Path(__file__).parents[2] / "results/tables/work_precision.csv"
DOCS = Path(__file__).parents[2] / "docs/performance.md"


@pytest.fixture(scope="module", params=[TABLE, MADE], ids=["published", "made"])
def table(request):
    return read_table(request.param)


def test_the_published_chart_draws_all_peers_and_the_factor_in_the_docs():
    published = read_table(TABLE)
    assert set(published["method"]) > {"heyoka", "cvode_adams", "scipy_dop853"}
    drawn = speed.draw(published)
    said = re.search(r"heyoka takes (\d+)\s+times", DOCS.read_text()).group(1)
    assert f"{said} times  " in [text.get_text() for text in drawn.axes[0].texts]


def test_every_method_that_comes_as_close_as_the_exact_solver_takes_longer(table):
    assert set(table["scene"]) == {"uniform"}
    is_right = table["transitions_right"].eq(table["transitions_true"])
    (exact,) = table[is_right & table["method"].eq("exact")].to_dict("records")
    whole = table[is_right & table["method"].ne("exact")]
    as_close = whole[whole["time_error_s"] <= exact["time_error_s"]]
    assert (as_close["seconds"] > exact["seconds"]).all()
    assert set(as_close["method"]) <= {"heyoka"}
