"""The scripts do what their tables and figures promise, and say in one line what goes wrong."""

import csv

import numpy as np
import pandas as pd
import print_reproduction
import pytest
import simulate_scene
import tabulate_mu_sapp
import tabulate_reproduction

from precursors import Chain, find_slips, simulate
from precursors.analysis.load_curve import TOLERANCE_N
from precursors.support.files import read_table

STEEP = """\
  steep:
    title: nearly all of the load at the leading edge
    theta: "9/10"
    duration: 0.5
"""


@pytest.fixture(scope="module")
def run():
    return simulate(Chain.from_slider(), duration=3.0)


@pytest.fixture(scope="module")
def files(run, tmp_path_factory):
    directory = tmp_path_factory.mktemp("files")
    outputs = (directory / name for name in ("run.h5", "slips.csv", "trace.csv"))
    simulate_scene.main({"theta": 0.0, "normal_load": 400.0}, run.duration, {}, *outputs)
    tabulate_mu_sapp.main({"fig10": directory / "slips.csv"}, directory / "mu_sapp.csv")
    return directory


def test_the_slip_table_holds_every_event_with_every_digit(run, files):
    table = read_table(files / "slips.csv")
    slips = find_slips(run)
    assert list(table.columns) == [
        "onset_s",
        "end_s",
        "load_before_N",
        "load_after_N",
        "largest_load_N",
        "front",
        "n_slid",
        "n_simultaneous",
        "is_global",
        "counted",
        "theta",
        "n_blocks",
        "normal_load_N",
        "length_m",
    ]
    slider = table[["theta", "n_blocks", "normal_load_N", "length_m"]].drop_duplicates()
    assert slider.to_numpy().tolist() == [[0, 10, 400, 0.1]]
    np.testing.assert_array_equal(table["onset_s"], slips["onset"])
    np.testing.assert_array_equal(table["load_after_N"], slips["load_after"])
    assert table["counted"].sum() == 9
    assert table.loc[table["is_global"], "counted"].tolist() == [True]


def test_the_trace_goes_through_every_transition_from_start_to_end(run, files):
    trace = read_table(files / "trace.csv").set_index("time_s")["tangential_load_N"]
    assert (trace.index[0], trace.index[-1]) == (0.0, 3.0)
    assert trace.index.is_monotonic_increasing
    transitions = pd.Series(run.transitions["tangential_load"], index=run.transitions["time"])
    # The same instant computed from the stored state and along the run: rounding of 200 N.
    np.testing.assert_allclose(trace[transitions.index], transitions, rtol=0, atol=1e-9)


def test_straight_lines_between_the_rows_of_the_trace_draw_every_slip(run, files):
    trace = read_table(files / "trace.csv")
    slips = find_slips(run)
    times = np.linspace(slips["onset"], slips["end"], 1000).T.ravel()
    drawn = np.interp(times, trace["time_s"], trace["tangential_load_N"])
    assert np.abs(drawn - run.tangential_load(times)).max() <= TOLERANCE_N


def test_mu_sapp_is_tabulated_under_every_definition_and_one_is_the_papers(files):
    table = read_table(files / "mu_sapp.csv")
    assert table["definition"].is_unique
    assert len(table) > 1
    papers = table[table["is_papers"]]
    assert len(papers) == 1
    assert papers["mu_sapp"].item() == pytest.approx(0.4858, abs=5e-5)
    assert papers["events_counted"].item() == 9
    assert papers["load_N"].item() == pytest.approx(400 * papers["mu_sapp"].item())


def test_a_run_without_a_slip_gives_tables_without_rows(tmp_path):
    simulate_scene.main({}, 0.1, {}, *(tmp_path / name for name in ("run.h5", "slips.csv", "trace.csv")))
    tabulate_mu_sapp.main({"calm": tmp_path / "slips.csv"}, tmp_path / "mu_sapp.csv")
    tabulate_reproduction.main(
        {"calm": tmp_path / "slips.csv"},
        tmp_path / "mu_sapp.csv",
        {"calm": {}},
        tmp_path / "r.csv",
    )
    assert read_table(tmp_path / "slips.csv").empty
    assert read_table(tmp_path / "trace.csv")["tangential_load_N"].tolist() == pytest.approx([0.0, 8.0])
    assert read_table(tmp_path / "mu_sapp.csv").empty
    assert read_table(tmp_path / "r.csv")["reproduced"].isna().sum() == 4


def test_the_reproduction_stands_beside_the_paper(files, tmp_path, capsys):
    tabulate_reproduction.main(
        {"fig10": files / "slips.csv"},
        files / "mu_sapp.csv",
        {"fig10": {"events_counted": 9, "mu_sapp": 0.49}},
        tmp_path / "reproduction.csv",
    )
    table = read_table(tmp_path / "reproduction.csv")
    assert list(table.columns) == ["scene", "theta", "quantity", "unit", "paper", "reproduced"]
    assert table["paper"].tolist()[:2] == [9, 0.49]
    assert table["reproduced"].tolist() == pytest.approx([9, 0.4858, 2.739, 194.31, 16], rel=1e-4)
    print_reproduction.main(tmp_path / "reproduction.csv", "results/figures")
    printed = capsys.readouterr().out
    assert ["0.49", "0.4858"] in [line.split()[-2:] for line in printed.splitlines()]
    assert ["-", "2.739"] in [line.split()[-2:] for line in printed.splitlines()]


def test_a_number_that_the_paper_does_not_give_stays_empty(files, tmp_path):
    tabulate_reproduction.main(
        {"mine": files / "slips.csv"}, files / "mu_sapp.csv", {"mine": {}}, tmp_path / "r.csv"
    )
    with (tmp_path / "r.csv").open(encoding="utf-8") as file:
        assert {row["paper"] for row in csv.DictReader(file)} == {""}


def test_a_scene_is_simulated_once_and_a_damaged_table_is_one_line(compiled_workspace):
    workspace = compiled_workspace
    workspace.edit("config.yaml", "\nfig13: [", f"{STEEP}\nfig13: [")
    target = "results/tables/mu_sapp.csv"
    outcome = workspace.run("-c2", target)
    assert outcome.code == 0, outcome.text
    assert len(outcome.jobs) == 5
    assert len(read_table(workspace.path / "results/tables/steep_trace.csv")) > 10
    assert "Nothing to be done" in workspace.run("-c2", target).text

    log = workspace.path / "results/logs/tabulate_mu_sapp.log"
    (workspace.path / "results/tables/steep_slips.csv").write_bytes(b"")
    outcome = workspace.run("-c2", "--rerun-triggers", "mtime", "--", target)
    assert outcome.code != 0
    assert log.read_text(encoding="utf-8").count("\n") == 1
    assert log.read_text(encoding="utf-8") in outcome.text
    assert "Traceback" not in outcome.text
