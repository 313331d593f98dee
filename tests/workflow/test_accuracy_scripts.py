"""Methods are measured to the first slip and to the end, and drawn from the table."""

import draw
import measure_methods
import pytest
import tabulate_failures
import tabulate_step_sweep

from precursors import Chain, simulate
from precursors.accuracy.failures.common import Threshold
from precursors.accuracy.failures.locating import SMALLEST
from precursors.accuracy.proof import ExactChain, certify
from precursors.accuracy.work_precision import COLUMNS
from precursors.figures import step_sweep
from precursors.support.files import read_table

VALUES = {
    "global slip": {"exact": [0.0], "leapfrog": [1e-6, 1e-7]},
    None: {"exact": [0.0]},
}
DURATION = 6.0


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    directory = tmp_path_factory.mktemp("accuracy")
    certificate = directory / "two.json.gz"
    certify(ExactChain.from_slider(n_blocks=2, theta="1/4"), DURATION).save(certificate)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(measure_methods, "charted_values", lambda case, _full: VALUES[case.until])
        measure_methods.main({"two": certificate}, {"two": 0.25}, False, directory / "methods.csv")
    return directory


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


def test_the_charts_are_drawn_from_the_tables(files):
    methods, time, evaluations = (
        str(files / name) for name in ("methods.csv", "time.png", "evaluations.svg")
    )
    draw.main("work_precision", {"table": methods}, {}, [time])
    draw.main("work_precision", {"table": methods}, {"work": "evaluations"}, [evaluations])
    assert (files / "time.png").read_bytes().startswith(b"\x89PNG")
    assert (files / "evaluations.svg").read_text(encoding="utf-8").rstrip().endswith("</svg>")


def test_the_step_sweep_is_a_table_that_the_figure_reads(tmp_path, monkeypatch):
    steps = {"rk4_skip": [1e-5, 3e-6, 1e-6], "rk4": [1e-5]}
    monkeypatch.setattr(tabulate_step_sweep, "charted_steps", lambda _full: steps)
    simulate(Chain.from_slider(), 10.0).save(tmp_path / "run.h5")
    tabulate_step_sweep.main({"scene": tmp_path / "run.h5"}, {"scene": 0.0}, False, tmp_path / "sweep.csv")
    table = read_table(tmp_path / "sweep.csv")
    assert table["method"].tolist() == ["exact", "rk4_skip", "rk4_skip", "rk4_skip", "rk4"]
    assert len(step_sweep.draw(table).axes) == 3


def test_failure_modes_are_tabulated_with_their_curves_and_thresholds(tmp_path, monkeypatch):
    monkeypatch.setattr(
        tabulate_failures, "thresholds", lambda: [Threshold("a", 2, "fails", "s", "b", 2.0, 3.0)]
    )
    modes, files = ("stiffness", "restart_on_root"), (tmp_path / "failures.csv", tmp_path / "thresholds.csv")
    tabulate_failures.main(*files, {mode: tmp_path / f"{mode}.csv" for mode in modes})
    numbers, thresholds = map(read_table, files)
    assert numbers["failure_mode"].tolist() == ["stiffness"] + ["restart_on_root"] * 2
    assert numbers["measured"].tolist()[1:] == [82, SMALLEST]
    assert thresholds["n_blocks"].tolist() == [2, 10]
    assert thresholds["ratio"].tolist() == [1.5, pytest.approx(1.0, rel=0.02)]
    assert len(read_table(tmp_path / "stiffness.csv")) == 24
