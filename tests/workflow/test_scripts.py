"""The scripts and the lists of tables give what they promise, and say in one line what goes wrong."""

from __future__ import annotations

import dataclasses
from pathlib import Path

import make_tables
import numpy as np
import pandas as pd
import print_reproduction
import prove_again
import pytest
import simulate_scene
import take_certificates

from precursors import Chain, find_slips, simulate
from precursors.accuracy import failures, work_precision
from precursors.accuracy.failures.common import Threshold
from precursors.accuracy.failures.locating import SMALLEST
from precursors.accuracy.proof import Certificate, CertificateError, ExactChain, certify
from precursors.accuracy.solver_vs_proof import proof_tables
from precursors.accuracy.step_sweep import sweep
from precursors.analysis.load_curve import TOLERANCE_N
from precursors.analysis.lyapunov import lyapunov_table
from precursors.reproduction.scene_numbers import reproduction_tables
from precursors.support.files import read_table

STEEP = """\
  steep:
    title: nearly all of the load at the leading edge
    theta: "9/10"
    duration: 0.5
"""
READERS = {".csv": "support.files:read_table"}
PAIR, DURATION = ExactChain.from_slider(n_blocks=2, theta="1/2", drive_velocity="1e-3"), 0.5


@pytest.fixture(scope="module")
def run():
    return simulate(Chain.from_slider(), duration=3.0)


@pytest.fixture(scope="module")
def files(run, tmp_path_factory):
    directory = tmp_path_factory.mktemp("files")
    outputs = (directory / name for name in ("run.h5", "slips.csv", "trace.csv"))
    simulate_scene.main({"theta": 0.0, "normal_load": 400.0}, run.duration, {}, *outputs)
    return directory


# A scene


def test_the_slip_table_holds_every_event_with_every_digit(run, files):
    table = read_table(files / "slips.csv")
    slips = find_slips(run)
    slider = table[["theta", "n_blocks", "normal_load_N", "length_m"]].drop_duplicates()
    assert slider.to_numpy().tolist() == [[0, 10, 400, 0.1]]
    np.testing.assert_array_equal(table["onset_s"], slips["onset"])
    np.testing.assert_array_equal(table["load_after_N"], slips["load_after"])
    assert table["counted"].sum() == 9
    assert table.loc[table["is_global"], "counted"].tolist() == [True]


def test_straight_lines_between_the_rows_of_the_trace_draw_every_transition_and_slip(run, files):
    trace = read_table(files / "trace.csv")
    assert trace["time_s"].iloc[[0, -1]].tolist() == [0.0, 3.0]
    loads = trace.set_index("time_s")["tangential_load_N"]
    transitions = pd.Series(run.transitions["tangential_load"], index=run.transitions["time"])
    # The same instant computed from the stored state and along the run: rounding of 200 N.
    np.testing.assert_allclose(loads[transitions.index], transitions, rtol=0, atol=1e-9)
    slips = find_slips(run)
    times = np.linspace(slips["onset"], slips["end"], 1000).T.ravel()
    drawn = np.interp(times, trace["time_s"], trace["tangential_load_N"])
    assert np.abs(drawn - run.tangential_load(times)).max() <= TOLERANCE_N


def test_the_reproduction_stands_beside_the_paper(files, tmp_path, capsys):
    names = ("mu_sapp", "reproduction")
    outputs = {name: str(tmp_path / f"{name}.csv") for name in names}
    inputs = {"slips": {"fig10": str(files / "slips.csv")}}
    options = {"paper": {"fig10": {"events_counted": 9, "mu_sapp": 0.49}}}
    function = "reproduction.scene_numbers:reproduction_tables"
    make_tables.main(function, inputs, options, outputs, READERS)
    mu_sapp, reproduction = (read_table(outputs[name]) for name in names)
    assert mu_sapp["definition"].is_unique
    (papers,) = mu_sapp[mu_sapp["is_papers"]].to_dict("records")
    assert papers["mu_sapp"] == pytest.approx(0.4858, abs=5e-5)
    assert papers["load_N"] == pytest.approx(400 * papers["mu_sapp"])
    assert reproduction["paper"].tolist()[:2] == [9, 0.49]
    assert reproduction["paper"][2:].isna().all()
    assert reproduction["reproduced"].tolist() == pytest.approx([9, 0.4858, 2.739, 194.31, 16], rel=1e-4)
    print_reproduction.main(outputs["reproduction"], "results/figures")
    printed = [line.split()[-2:] for line in capsys.readouterr().out.splitlines()]
    assert ["0.49", "0.4858"] in printed
    assert ["-", "2.739"] in printed


def test_a_run_without_a_slip_gives_tables_without_rows(tmp_path):
    simulate_scene.main({}, 0.1, {}, *(tmp_path / name for name in ("run.h5", "slips.csv", "trace.csv")))
    slips = read_table(tmp_path / "slips.csv")
    tables = reproduction_tables({"calm": slips}, {"calm": {}})
    assert slips.empty
    assert read_table(tmp_path / "trace.csv")["tangential_load_N"].tolist() == pytest.approx([0.0, 8.0])
    assert tables["mu_sapp"].empty
    assert tables["reproduction"]["reproduced"].isna().sum() == 4


def test_a_scene_is_simulated_once_and_a_damaged_table_is_one_line(workspace):
    workspace.edit("config.yaml", "\nfig13: [", f"{STEEP}\nfig13: [")
    target = "results/tables/mu_sapp.csv"
    outcome = workspace.run("-c2", target)
    assert outcome.code == 0, outcome.text
    assert len(outcome.jobs) == 5
    assert len(read_table(workspace.path / "results/tables/steep_trace.csv")) > 10
    assert "Nothing to be done" in workspace.run("-c2", target).text

    log = workspace.path / "results/logs/tabulate_reproduction.log"
    (workspace.path / "results/tables/steep_slips.csv").write_bytes(b"")
    outcome = workspace.run("-c2", "--rerun-triggers", "mtime", "--", target)
    assert outcome.code != 0
    assert log.read_text(encoding="utf-8").count("\n") == 1
    assert log.read_text(encoding="utf-8") in outcome.text
    assert "Traceback" not in outcome.text


# Proofs


@pytest.fixture(scope="module")
def committed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("committed") / "pair.json.gz"
    certify(PAIR, DURATION).save(path)
    return path


@pytest.mark.parametrize(
    ("chain", "duration", "is_taken"),
    [(PAIR, DURATION, True), (PAIR, 0.3, False), (dataclasses.replace(PAIR, mu_k="0.4"), DURATION, False)],
    ids=["the chain", "another duration", "another chain"],
)
def test_a_fitting_certificate_is_taken_over_and_another_chain_is_proved(
    committed: Path, tmp_path: Path, chain: ExactChain, duration: float, is_taken: bool
) -> None:
    output = tmp_path / "pair.json.gz"
    take_certificates.main([committed], [chain.as_text()], [duration], [output])
    certificate = Certificate.load(output)
    assert (certificate.chain, float(certificate.duration)) == (chain, duration)
    assert (output.read_bytes() == committed.read_bytes()) == is_taken


def test_a_certificate_is_proved_again_and_an_altered_one_refused(committed: Path, tmp_path: Path) -> None:
    prove_again.main(committed, tmp_path / "pair.csv")
    row = pd.read_csv(tmp_path / "pair.csv").iloc[0]
    certificate = Certificate.load(committed)
    assert (row["chain"], row["transitions"]) == ("pair", len(certificate.transitions))
    last = certificate.transitions[-1]
    wrong = last._replace(time=last.time._replace(midpoint=last.time.midpoint + last.time.radius * 3))
    altered = dataclasses.replace(certificate, transitions=(*certificate.transitions[:-1], wrong))
    altered.save(tmp_path / "altered.json.gz")
    with pytest.raises(CertificateError, match="its time is not proved"):
        prove_again.main(tmp_path / "altered.json.gz", tmp_path / "altered.csv")
    assert not (tmp_path / "altered.csv").exists()


def test_the_tables_hold_what_is_proved_and_what_the_solver_gets_right(committed: Path) -> None:
    certificate = Certificate.load(committed)
    effort = pd.DataFrame({"chain": ["else"], "transitions": [1], "cpu_s": [1.0]})
    tables = proof_tables({"pair": certificate}, effort, 1e-9)
    row, facts = tables["certificates"].iloc[0], tables["solver_vs_proof"].iloc[0]
    assert row["transitions"] == len(certificate.transitions)
    assert row["largest_time_width_s"] == float(2 * certificate.widest[0])
    # The time of another proof is not taken for that of this one.
    assert pd.isna(row["cpu_s"])
    assert facts["agreeing_transitions"] == facts["transitions"] == len(certificate.transitions)
    assert facts["horizon_s"] == facts["right_until_s"] == facts["duration_s"] == DURATION
    assert tables["horizon"]["actual_error_s"].iloc[-1] == facts["time_error_while_agreeing_s"]


# Methods


def test_methods_are_measured_to_the_first_slip_and_to_the_end(monkeypatch):
    values = {"global slip": {"exact": [0.0], "leapfrog": [1e-6, 1e-7]}, None: {"exact": [0.0]}}
    monkeypatch.setattr(work_precision, "charted_values", lambda case, _full: values[case.until])
    certificate = certify(ExactChain.from_slider(n_blocks=2, theta="1/4"), 6.0)
    table = work_precision.work_precision_table({"two": certificate}, {"two": 0.25}, False)
    assert table[["scene", "theta", "until", "truth", "method"]].to_numpy().tolist() == [
        ["two", 0.25, "global slip", "proved", "exact"],
        ["two", 0.25, "global slip", "proved", "leapfrog"],
        ["two", 0.25, "global slip", "proved", "leapfrog"],
        ["two", 0.25, "end", "proved", "exact"],
    ]
    exact = table[table["method"] == "exact"]
    assert (exact["transitions_right"] == exact["transitions_true"]).all()
    assert exact["transitions_true"].is_monotonic_increasing
    assert 0 < exact["error_time_s"].iloc[0] < table["error_time_s"].iloc[2]


def test_the_step_sweep_begins_with_the_exact_solver(run):
    rows = list(sweep(run, {"rk4_skip": [1e-5, 3e-6], "rk4": [1e-5]}))
    assert [row["method"] for row in rows] == ["exact", "rk4_skip", "rk4_skip", "rk4"]
    assert rows[0]["transitions_right"] == rows[0]["transitions_true"]


def test_failure_modes_are_tabulated_with_their_curves_and_thresholds(monkeypatch):
    two = {name: failures.FAILURE_MODES[name] for name in ("stiffness", "restart_on_root")}
    monkeypatch.setattr(failures, "FAILURE_MODES", two)
    monkeypatch.setattr(failures, "thresholds", lambda: [Threshold("a", 2, "fails", "s", "b", 2.0, 3.0)])
    tables = failures.failure_tables()
    assert tables["failures"]["failure_mode"].tolist() == ["stiffness"] + ["restart_on_root"] * 2
    assert tables["failures"]["measured"].tolist()[1:] == [82, SMALLEST]
    assert tables["thresholds"]["n_blocks"].tolist() == [2, 10]
    assert tables["thresholds"]["ratio"].tolist() == [1.5, pytest.approx(1.0, rel=0.02)]
    assert len(tables["stiffness"]) == 24


def test_a_scene_without_an_exponent_has_an_empty_row():
    sliders = {"alone": {"theta": 0.0, "n_blocks": 1, "drive_velocity": 0.02}}
    sliders["ten"] = {"theta": 0.5, "drive_velocity": 0.002}
    table = lyapunov_table(sliders, 2.0).set_index("scene")
    assert table["theta"].to_dict() == {"alone": 0.0, "ten": 0.5}
    assert table.loc["alone"].drop("theta").isna().all()
    assert table.loc["ten"].notna().all()
    assert table.loc["ten", "uncertainty_per_s"] > 0
