"""The scripts and the lists of tables give what they promise, and say in one line what goes wrong."""

from __future__ import annotations

import dataclasses
import json
import re
import runpy
import signal
import subprocess
import sys
from pathlib import Path
from textwrap import wrap
from types import ModuleType
from typing import Any

import check_claims
import codecheck
import numpy as np
import pandas as pd
import pytest
import yaml
from conftest import ROOT
from matplotlib import image
from matplotlib.figure import Figure

from precursors import Chain, find_slips, simulate
from precursors.accuracy import failures, work_precision
from precursors.accuracy.failures.common import Threshold
from precursors.accuracy.failures.locating import SMALLEST
from precursors.accuracy.proof import Certificate, ExactChain, certify
from precursors.accuracy.solver_vs_proof import proof_tables
from precursors.analysis.load_curve import TOLERANCE_N
from precursors.analysis.lyapunov import lyapunov_table
from precursors.ensembles.studies import make_study
from precursors.ensembles.study import run_members
from precursors.figures import style
from precursors.reproduction.scene_numbers import reproduction_tables
from precursors.support.files import read_table

READERS = {".csv": "support.files:read_table"}
SCRIPTS = ROOT / "workflow/scripts"
PAIR, DURATION = ExactChain.from_slider(n_blocks=2, theta="1/2", drive_velocity="1e-3"), 0.5


class Named(list):
    """A list whose last entries have names, as a script is given files and parameters by Snakemake."""

    def __init__(self, *values: Any, **named: Any) -> None:
        super().__init__([*values, *named.values()])
        vars(self).update(named)

    def get(self, name: str, default: Any) -> Any:
        return getattr(self, name, default)


def run_script(name: str, directory: Path, **job: Any) -> str:
    """Run a script as a job of the rule "rule" does; its log."""
    given = {key: job.get(key, Named()) for key in ("input", "output", "params", "wildcards", "resources")}
    log, handler = directory / f"{name}.log", signal.getsignal(signal.SIGINT)
    snakemake = Named(rule="rule", log=[log], config=job.get("config"), **given)
    try:
        runpy.run_path(str(SCRIPTS / f"{name}.py"), {"snakemake": snakemake}, "__main__")
        assert signal.getsignal(signal.SIGINT) == signal.SIG_DFL  # compiled code is stopped at once
    finally:
        signal.signal(signal.SIGINT, handler)
    return log.read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def run():
    return simulate(Chain.from_slider(), duration=3.0)


@pytest.fixture(scope="module")
def files(run, tmp_path_factory):
    directory = tmp_path_factory.mktemp("files")
    simulate_scene(directory, {"theta": 0.0, "normal_load": 400.0}, run.duration)
    return directory


def simulate_scene(directory, slider, duration, **additions):
    names = {"run": "run.h5", "slips": "slips.csv", "trace": "trace.csv"}
    output = Named(**{name: directory / file for name, file in names.items()})
    params = Named(slider=slider, duration=duration, additions=additions)
    return run_script("simulate_scene", directory, output=output, params=params)


# A job


@pytest.mark.parametrize(("seconds", "told"), [(4, ""), (5, "rule, fig10: some 5 s\n")])
def test_a_job_logs_what_it_took_and_tells_beforehand_if_that_is_long(tmp_path, capsys, seconds, told):
    params = Named(function="support.files:read_table", inputs={}, options={"path": tmp_path / "a.csv"})
    params.names, params.readers = ["a"], READERS
    (tmp_path / "a.csv").write_text("x\n1\n")
    job = {"wildcards": Named(scene="fig10"), "resources": Named(seconds=seconds)}
    log = run_script("make_tables", tmp_path, output=Named(str(tmp_path / "b.csv")), params=params, **job)
    assert re.fullmatch(r"rule, fig10: \d\.\d{3} s\n", log)
    assert capsys.readouterr().err == told
    assert (tmp_path / "b.csv").read_text() == "x\n1\n"


def test_what_goes_wrong_in_a_job_is_one_line_and_a_traceback_in_its_log_if_it_is_ours(tmp_path):
    params = Named(function="support.files:read_table", inputs={}, options={"path": tmp_path / "none.csv"})
    params.names, params.readers = ["a"], READERS
    with pytest.raises(SystemExit, match=r"^rule: .*none\.csv'$"):
        run_script("make_tables", tmp_path, output=Named("a.csv"), params=params)
    assert (tmp_path / "make_tables.log").read_text().count("\n") == 1
    params.function = "support.files:no_function"
    with pytest.raises(SystemExit, match=r"^rule: .*no_function"):
        run_script("make_tables", tmp_path, output=Named("a.csv"), params=params)
    assert "\nTraceback" in (tmp_path / "make_tables.log").read_text()


def test_each_figure_is_drawn_from_its_tables_into_its_own_files(tmp_path, monkeypatch):
    def draw(table, title, look=None):
        figure = Figure(figsize=(2, 1))
        figure.text(0, 0, f"{title} {len(table)} {[len(each) for each in table]} {look and look.font_size}")
        return figure

    monkeypatch.setitem(sys.modules, "precursors.figures.ours", module := ModuleType("ours"))
    module.draw = draw
    (tmp_path / "a.csv").write_text("x\n1\n2\n")
    table, look = str(tmp_path / "a.csv"), {"font_size": 9.0}
    figures = {
        "ours": {"tables": {"table": table}, "options": {"title": "one"}, "look": {}},
        "two": {"module": "ours", "tables": {"table": [table]}, "options": {"title": "two"}, "look": look},
    }
    output = Named(*(tmp_path / f"{name}.{kind}" for name in figures for kind in ("svg", "png")))
    run_script("draw", tmp_path, output=output, params=Named(figures=figures, readers=READERS))
    one, two = draw(read_table(table), "one"), draw([read_table(table)], "two", style.Look(**look))
    for name, figure, looks in (("ours", one, {}), ("two", two, {"look": style.Look(**look)})):
        for kind in ("svg", "png"):
            style.save(figure, tmp_path / f"expected.{kind}", **looks)
            assert (tmp_path / f"{name}.{kind}").read_bytes() == (tmp_path / f"expected.{kind}").read_bytes()


def test_the_chunks_of_a_study_together_are_its_runs(tmp_path):
    config = yaml.safe_load((ROOT / "config.yaml").read_text(encoding="utf-8"))
    arguments = {"slider": config["chain"], "points": 5}  # a square of four
    for chunk in ("1of2", "2of2"):
        wildcards = Named(study="map_theta_friction_ratio", chunk=chunk)
        job = {"wildcards": wildcards, "params": Named(arguments=arguments)}
        run_script("run_chunk", tmp_path, output=Named(chunk=tmp_path / f"{chunk}.csv"), **job)
    chunks = [pd.read_csv(tmp_path / f"{chunk}.csv", index_col="member") for chunk in ("1of2", "2of2")]
    whole = run_members(make_study("map_theta_friction_ratio", arguments))
    assert [len(chunk) for chunk in chunks] == [2, 2]
    together = pd.concat(chunks).sort_index()
    pd.testing.assert_frame_equal(together, whole, check_names=False, check_dtype=False)


def test_the_provenance_is_that_of_the_directory_of_the_results(tmp_path):
    (tmp_path / "a.csv").write_text("abc")
    job = {"params": Named(root=str(ROOT)), "config": {"duration": 3.0, "title": "ä"}}
    run_script("write_provenance", tmp_path, output=Named(json=tmp_path / "provenance.json"), **job)
    text = (tmp_path / "provenance.json").read_text(encoding="utf-8")
    found = json.loads(text)
    assert found["config"] == job["config"]
    assert found["outputs"]["a.csv"]["bytes"] == 3
    assert "config.yaml" in found["inputs"]
    assert '"ä"' in text
    assert text.endswith("}\n")


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


REPRODUCTION = """\
       theta quantity                                                   unit  paper  reproduced
fig10 0       events counted in Fig. 13, the first global slip included  1      9        9     
fig10 0                    apparent static friction coefficient mu_sapp  1   0.49   0.4858     
fig10 0                                   time of the first global slip  s      -    2.739     
fig10 0                                   load at the first global slip  N      -    194.3     
fig10 0                          all events up to the first global slip  1      -       16     
"""  # noqa: W291


def test_the_reproduction_stands_beside_the_paper(files, tmp_path):
    names = ("mu_sapp", "reproduction")
    outputs = [str(tmp_path / f"{name}.csv") for name in names]
    params = Named(
        function="reproduction.scene_numbers:reproduction_tables",
        inputs={"slips": {"fig10": str(files / "slips.csv")}},
        options={"paper": {"fig10": {"events_counted": 9, "mu_sapp": 0.49}}},
        names=names,
        readers=READERS,
    )
    run_script("make_tables", tmp_path, output=Named(*outputs), params=params)
    mu_sapp, reproduction = map(read_table, outputs)
    assert mu_sapp["definition"].is_unique
    (papers,) = mu_sapp[mu_sapp["is_papers"]].to_dict("records")
    assert papers["mu_sapp"] == pytest.approx(0.4858, abs=5e-5)
    assert papers["load_N"] == pytest.approx(400 * papers["mu_sapp"])
    assert reproduction["paper"].tolist()[:2] == [9, 0.49]
    assert reproduction["paper"][2:].isna().all()
    assert reproduction["reproduced"].tolist() == pytest.approx([9, 0.4858, 2.739, 194.31, 16], rel=1e-4)
    (tmp_path / "b.svg").touch()
    (tmp_path / "a.svg").touch()
    command = [sys.executable, SCRIPTS / "print_reproduction.py", outputs[1], tmp_path]
    told = subprocess.run(command, capture_output=True, text=True)
    assert told.stdout == REPRODUCTION + f"Figures: a.svg, b.svg in {tmp_path}\n"


@pytest.mark.parametrize(
    ("script", "arguments", "told"),
    [
        ("print_reproduction", ["none.csv", "figures"], "reproduction: "),
        ("check_claims", ["none"], "check: "),
        ("codecheck", [], "codecheck: "),
    ],
)
def test_a_script_that_make_runs_says_in_one_line_which_file_is_missing(tmp_path, script, arguments, told):
    command = [sys.executable, SCRIPTS / f"{script}.py", *arguments]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True)
    assert (done.returncode, done.stdout, done.stderr.count("\n")) == (1, "", 1)
    assert done.stderr.startswith(told)
    assert arguments[:1] == [] or arguments[0] in done.stderr


def test_a_run_without_a_slip_gives_tables_without_rows(tmp_path):
    simulate_scene(tmp_path, {}, 0.1)
    slips = read_table(tmp_path / "slips.csv")
    tables = reproduction_tables({"calm": slips}, {"calm": {}})
    assert slips.empty
    assert read_table(tmp_path / "trace.csv")["tangential_load_N"].tolist() == pytest.approx([0.0, 8.0])
    assert tables["mu_sapp"].empty
    assert tables["reproduction"]["reproduced"].isna().sum() == 4


def test_a_claim_is_printed_with_its_verdict_its_numbers_and_its_shares():
    words, rule = "There are " + "very " * 20 + "many.", "below 7"
    rows = [
        ("six", "3", "result", "holds", "N", "5", words, "6", rule, 0.254, 0.0),
        ("one", "4", "result", "does not hold", "1", "", "One.", "2", rule, None, None),
    ]
    columns = ["claim", "section", "kind", "verdict", "unit", "expected", "statement", "ours", "rule"]
    claims = pd.DataFrame(rows, columns=[*columns, "noise_share", "digits_share"])
    shares = "25 % of the draws of noise; 0 % of the draws of digits"
    lines = [*wrap(words, 106), *wrap(f"6 N (5 N): below 7; {shares}", 106)]
    told = [" 1  HOLDS  [six]  3", *(f"    {line}" for line in lines)]
    told += [" 2  DOES NOT HOLD  [one]  4", "    One.", "    2: below 7"]
    assert "\n".join(check_claims.entries(claims)).splitlines() == told
    assert list(check_claims.totals(claims)) == [
        "0 of kind 'chose the readings': ",
        "2 of kind 'result': 1 holds, 1 does not hold",
    ]


@pytest.mark.parametrize(
    ("value", "is_kept"), [(1.0 + 0.9e-6, True), (1.0 + 1.2e-6, False), (0.9e-9, True), (1.2e-9, False)]
)
def test_a_number_is_as_kept_within_a_millionth(tmp_path, value, is_kept):
    for name, number in (("made", value), ("kept", float(round(value)))):
        pd.DataFrame({"x": [number]}).to_csv(tmp_path / f"{name}.csv", index=False)
    assert (codecheck.difference(tmp_path / "made.csv", tmp_path / "kept.csv") == "") == is_kept


@pytest.mark.parametrize(
    ("shade", "rows", "told"), [(0.518, 8, ""), (0.525, 8, "another picture"), (0.5, 7, "another picture")]
)
def test_a_picture_is_as_kept_if_it_looks_the_same(tmp_path, shade, rows, told):
    image.imsave(tmp_path / "kept.png", np.full((8, 8, 3), 0.5))
    image.imsave(tmp_path / "made.png", np.full((rows, 8, 3), shade))
    assert codecheck.difference(tmp_path / "made.png", tmp_path / "kept.png") == told


def test_a_file_that_differs_is_named(tmp_path):
    (tmp_path / "results").mkdir()
    (tmp_path / "codecheck.yml").write_text("manifest: [{file: results/a.csv}, {file: results/b.csv}]")
    (tmp_path / "tests/golden").mkdir(parents=True)
    for name, value in (("a", 1.0), ("b", 2.0)):
        pd.DataFrame({"x": [value]}).to_csv(tmp_path / f"results/{name}.csv", index=False)
        pd.DataFrame({"x": [1.0]}).to_csv(tmp_path / f"tests/golden/{name}.csv", index=False)
    script = [sys.executable, SCRIPTS / "codecheck.py"]
    done = subprocess.run(script, cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 1
    assert "results/a.csv: as kept" in done.stdout
    assert "results/b.csv: DataFrame.iloc" in done.stdout
    assert "1 of 2 files as kept" in done.stdout


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
    params = Named(chains=[chain.as_text()], durations=[duration])
    job = {"input": Named(committed=[committed]), "params": params}
    run_script("take_certificates", tmp_path, output=Named(output), **job)
    certificate = Certificate.load(output)
    assert (certificate.chain, float(certificate.duration)) == (chain, duration)
    assert (output.read_bytes() == committed.read_bytes()) == is_taken


def test_a_certificate_is_proved_again_and_an_altered_one_refused(committed: Path, tmp_path: Path) -> None:
    def prove_again(certificate):
        output = Named(table=tmp_path / "pair.csv")
        run_script("prove_again", tmp_path, input=Named(certificate=certificate), output=output)

    prove_again(committed)
    row = pd.read_csv(tmp_path / "pair.csv").iloc[0]
    certificate = Certificate.load(committed)
    assert (row["chain"], row["transitions"]) == ("pair", len(certificate.transitions))
    assert 0.0 <= row["cpu_s"] < 60.0
    last = certificate.transitions[-1]
    wrong = last._replace(time=last.time._replace(midpoint=last.time.midpoint + last.time.radius * 3))
    altered = dataclasses.replace(certificate, transitions=(*certificate.transitions[:-1], wrong))
    altered.save(tmp_path / "altered.json.gz")
    (tmp_path / "pair.csv").unlink()
    with pytest.raises(SystemExit, match="its time is not proved"):
        prove_again(tmp_path / "altered.json.gz")
    assert not (tmp_path / "pair.csv").exists()


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
