"""Methods are measured in the size that is asked for, held to the truth, and drawn from the table."""

import draw
import measure_growth
import measure_methods
import pytest
import yaml
from conftest import ROOT

from precursors.accuracy.proof import ExactChain, certify
from precursors.accuracy.work_precision import COLUMNS, check_methods
from precursors.support.files import read_table

CONFIG = yaml.safe_load((ROOT / "config.yaml").read_text(encoding="utf-8"))
SIZE = {
    "repetitions": 5,
    "longest": 1.0,
    "first_slip": {"exact": "sweep", "leapfrog": [1e-6, 1e-7]},
    "whole_run": {"exact": "sweep"},
}
DURATION = 6.0


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    directory = tmp_path_factory.mktemp("accuracy")
    certify(ExactChain.from_slider(n_blocks=2, theta="1/4"), DURATION).save(directory / "two.json.gz")
    measure(directory, SIZE)
    measure_growth.main(
        {"sizes": [5, 10], "repetitions": 5, "least_transitions": 20, "transitions_per_block": 1},
        directory / "growth.csv",
    )
    return directory


def measure(directory, size):
    certificates, thetas = {"two": directory / "two.json.gz"}, {"two": 0.25}
    measure_methods.main(certificates, thetas, size, directory / "methods.csv")


def test_methods_are_measured_to_the_first_slip_and_to_the_end(files):
    table = read_table(files / "methods.csv")
    assert list(table.columns) == COLUMNS
    assert table[["until", "truth", "method"]].to_numpy().tolist() == [
        ["global slip", "proved", "exact"],
        ["global slip", "proved", "leapfrog"],
        ["global slip", "proved", "leapfrog"],
        ["end", "proved", "exact"],
    ]
    assert table["scene"].eq("two").all()
    assert table["theta"].eq(0.25).all()
    exact = table[table["method"] == "exact"]
    assert (exact["transitions_right"] == exact["transitions_true"]).all()
    assert exact["transitions_true"].is_monotonic_increasing
    assert 0 < exact["error_time_s"].iloc[0] < table["error_time_s"].iloc[2]


def test_a_name_that_is_no_methods_is_refused_before_anything_is_measured(files):
    with pytest.raises(ValueError, match="no method 'leapfrogs'"):
        measure(files, SIZE | {"whole_run": {"leapfrogs": "sweep"}})


def test_the_charts_are_drawn_from_the_tables(files):
    methods, time, evaluations = (
        str(files / name) for name in ("methods.csv", "time.png", "evaluations.svg")
    )
    draw.main("work_precision", {"table": methods}, {}, [time])
    draw.main("work_precision", {"table": methods}, {"work": "evaluations"}, [evaluations])
    draw.main("cost_per_event", {"table": str(files / "growth.csv")}, {}, [str(files / "cost.svg")])
    assert (files / "time.png").read_bytes().startswith(b"\x89PNG")
    for name in ("evaluations.svg", "cost.svg"):
        assert (files / name).read_text(encoding="utf-8").rstrip().endswith("</svg>")


@pytest.mark.parametrize("size", ["default", "full"])
@pytest.mark.parametrize("extent", ["first_slip", "whole_run"])
def test_the_configuration_names_methods_only_and_the_exact_solver_first(size, extent):
    names = list(CONFIG["accuracy"]["work_precision"][size][extent])
    check_methods(names)
    assert names[0] == "exact"
