"""The comparison of methods, published and made anew.

`snakemake -c2 --configfile config.yaml workflow/full.yaml -- accuracy` measures anew,
some ten minutes with nothing else running; its table and speed.png drawn from it then
replace paper/tables/work_precision_full.csv and the golden chart.
"""

import pytest
from places import committed, made


@pytest.mark.parametrize(
    ("read", "name"), [(committed, "work_precision_full"), (made, "work_precision")]
)
def test_every_method_that_comes_as_close_as_the_exact_solver_takes_longer(read, name):
    table = read(name)
    assert set(table["scene"]) == {"uniform"}
    is_right = table["transitions_right"].eq(table["transitions_true"])
    (exact,) = table[is_right & table["method"].eq("exact")].to_dict("records")
    whole = table[is_right & table["method"].ne("exact")]
    as_close = whole[whole["time_error_s"] <= exact["time_error_s"]]
    assert (as_close["seconds"] > exact["seconds"]).all()
    assert set(as_close["method"]) <= {"heyoka"}
