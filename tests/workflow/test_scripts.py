"""The scripts and the lists of tables give what they promise, and say in one line what
goes wrong."""

from __future__ import annotations

import dataclasses
import json
import re
import runpy
import signal
import subprocess
import sys
from functools import partial
from pathlib import Path
from types import ModuleType
from typing import Any

import codecheck
import numpy as np
import pandas as pd
import print_reproduction
import pytest
from conftest import ROOT
from matplotlib import image
from matplotlib.figure import Figure
from studies.made import MAP

from maegawa2010.entries import Figure as Drawn
from maegawa2010.studies.horizon.lyapunov import lyapunov_table
from maegawa2010.studies.horizon.tables import proof_tables
from maegawa2010.studies.work_precision import tables as work_precision
from precursors import Record, Run, simulate
from precursors.analysis.load_curve import load_trace
from precursors.analysis.slips import slip_table
from precursors.figures import style
from precursors.larger.run import LargerRun
from precursors.proof import Certificate, ExactChain, certify
from precursors.support.files import read_table

READERS = {".csv": "precursors.support.files:read_table"}
SCRIPTS = ROOT / "workflow/scripts"
PAIR, DURATION = (
    ExactChain.from_slider(n_blocks=2, theta="1/2", drive_velocity="1e-3"),
    0.5,
)


class Named(list):
    """A list whose last entries have names, as a script is given files and parameters
    by Snakemake."""

    def __init__(self, *values: Any, **named: Any) -> None:
        super().__init__([*values, *named.values()])
        vars(self).update(named)

    def get(self, name: str, default: Any) -> Any:
        return getattr(self, name, default)


def run_script(name: str, directory: Path, **job: Any) -> str:
    """Run a script as a job of the rule "rule" does; its log."""
    given = {
        key: job.get(key, Named())
        for key in ("input", "output", "params", "wildcards", "resources")
    }
    log, handler = directory / f"{name}.log", signal.getsignal(signal.SIGINT)
    snakemake = Named(rule="rule", log=[log], config=job.get("config"), **given)
    try:
        runpy.run_path(
            str(SCRIPTS / f"{name}.py"), {"snakemake": snakemake}, "__main__"
        )
        assert (
            signal.getsignal(signal.SIGINT) == signal.SIG_DFL
        )  # compiled code is stopped at once
    finally:
        signal.signal(signal.SIGINT, handler)
    return log.read_text(encoding="utf-8")


# A job


@pytest.mark.parametrize(("seconds", "told"), [(4, ""), (5, "rule, fig10: some 5 s\n")])
def test_a_job_logs_what_it_took_and_tells_beforehand_if_that_is_long(
    tmp_path, capsys, seconds, told
):
    params = Named(
        function="precursors.support.files:read_table",
        inputs={},
        options={"path": tmp_path / "a.csv"},
    )
    params.names, params.readers = ["a"], READERS
    (tmp_path / "a.csv").write_text("x\n1\n")
    job = {"wildcards": Named(scene="fig10"), "resources": Named(seconds=seconds)}
    log = run_script(
        "make_tables",
        tmp_path,
        output=Named(str(tmp_path / "b.csv")),
        params=params,
        **job,
    )
    assert re.fullmatch(r"rule, fig10: \d\.\d{3} s\n", log)
    assert capsys.readouterr().err == told
    assert (tmp_path / "b.csv").read_text() == "x\n1\n"


def test_what_goes_wrong_in_a_job_is_one_line_and_a_traceback_in_its_log_if_it_is_ours(
    tmp_path,
):
    params = Named(
        function="precursors.support.files:read_table",
        inputs={},
        options={"path": tmp_path / "none.csv"},
    )
    params.names, params.readers = ["a"], READERS
    with pytest.raises(SystemExit, match=r"^rule: .*none\.csv'$"):
        run_script("make_tables", tmp_path, output=Named("a.csv"), params=params)
    assert (tmp_path / "make_tables.log").read_text().count("\n") == 1
    params.function = "precursors.support.files:no_function"
    with pytest.raises(SystemExit, match=r"^rule: .*no_function"):
        run_script("make_tables", tmp_path, output=Named("a.csv"), params=params)
    assert "\nTraceback" in (tmp_path / "make_tables.log").read_text()


def test_each_figure_is_drawn_from_its_tables_into_its_own_files(tmp_path, monkeypatch):
    def draw(table, title, look=None):
        figure = Figure(figsize=(2, 1))
        figure.text(
            0,
            0,
            f"{title} {len(table)} {[len(each) for each in table]} {look and look.font_size}",
        )
        return figure

    monkeypatch.setitem(
        sys.modules, "precursors.figures.ours", module := ModuleType("ours")
    )
    module.draw = draw
    (tmp_path / "a.csv").write_text("x\n1\n2\n")
    table, look = str(tmp_path / "a.csv"), style.Look(font_size=9.0)
    drawn = Drawn(section="mine", function="precursors.figures.ours:draw", shows="some")
    figures = {
        "ours": dataclasses.asdict(
            dataclasses.replace(
                drawn, tables={"table": table}, options={"title": "one"}
            )
        ),
        "two": dataclasses.asdict(
            dataclasses.replace(
                drawn,
                tables={"table": [table]},
                options={"title": "two"},
                look={"font_size": 9.0},
            )
        ),
    }
    output = Named(
        *(tmp_path / f"{name}.{kind}" for name in figures for kind in ("svg", "png"))
    )
    run_script(
        "draw", tmp_path, output=output, params=Named(figures=figures, readers=READERS)
    )
    for path in output:
        name, x = path.stem, read_table(table)
        figure, of_page = (
            (draw(x, "one"), style.LOOK)
            if name == "ours"
            else (draw([x], "two", look), look)
        )
        expected = tmp_path / f"expected{path.suffix}"
        style.save(figure, expected, of_page, title=figures[name]["shows"])
        assert path.read_bytes() == expected.read_bytes()


def test_a_chunk_of_a_study_has_every_nth_member(tmp_path):
    output = Named(chunk=tmp_path / "2of3.csv")
    axes = [
        {"key": "theta", "from": -0.95, "to": 0.95, "points": 2},
        {"key": "mu_k", "from": 0.1, "to": 0.5, "points": 2},
    ]
    arguments = {"slider": {"mu_s": 0.7, "n_blocks": 2}, "axes": axes}
    job = {
        "wildcards": Named(study=MAP, chunk="2of3"),
        "params": Named(
            function="maegawa2010.studies.grid.tables:grid_study",
            options=arguments,
        ),
    }
    run_script("run_chunk", tmp_path, output=output, **job)
    chunk = pd.read_csv(output.chunk)
    assert (chunk["member"].tolist(), chunk["theta"].tolist()) == ([1], [0.95])


# A scene


def simulate_scene(directory, slider, duration, **additions):
    names = {"run": "run.h5", "slips": "slips.csv", "trace": "trace.csv"}
    output = Named(**{name: directory / file for name, file in names.items()})
    params = Named(slider=slider, duration=duration, additions=additions)
    return run_script("simulate_scene", directory, output=output, params=params)


@pytest.mark.parametrize("additions", [{}, {"viscosity": 50.0}])
def test_a_scene_has_its_run_its_slips_and_its_trace(tmp_path, additions):
    simulate_scene(tmp_path, {"theta": 0.0, "normal_load": 400.0}, 1.0, **additions)
    run = Record.load(tmp_path / "run.h5")
    assert (run.duration, run.chain.theta) == (1.0, 0.0)
    assert isinstance(run, LargerRun if additions else Run)
    for name, table in (("slips", slip_table(run)), ("trace", load_trace(run))):
        pd.testing.assert_frame_equal(
            read_table(tmp_path / f"{name}.csv"), table, check_exact=True
        )


def test_a_run_that_meets_its_cap_is_kept_under_another_name(tmp_path, monkeypatch):
    capped = partial(simulate, max_transitions=100)
    monkeypatch.setattr("precursors.solver.simulate.simulate", capped)
    with pytest.raises(SystemExit, match="max_transitions = 100 reached"):
        simulate_scene(tmp_path, {}, 3.0)
    assert len(Run.load(tmp_path / "run.unfinished.h5").transitions) == 100
    assert not (tmp_path / "run.h5").exists()


# What make calls


def call(
    name: str, directory: Path, *arguments: object
) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, SCRIPTS / f"{name}.py", *arguments]
    return subprocess.run(command, cwd=directory, capture_output=True, text=True)


REPRODUCTION = """\
       theta quantity                                                   unit  paper  reproduced
fig10 0       events counted in Fig. 13, the first global slip included  1      9        9     
fig10 0                    apparent static friction coefficient mu_sapp  1   0.49   0.4858     
fig10 0                                   time of the first global slip  s      -    2.739     
fig10 0                                   load at the first global slip  N      -    194.3     
fig10 0                          all events up to the first global slip  1      -       16     
"""  # noqa: W291


def test_the_reproduction_is_printed_beside_the_paper_with_the_names_of_the_figures(
    tmp_path, capsys
):
    golden = pd.read_csv(ROOT / "tests/golden/reproduction.csv").query(
        "scene == 'fig10'"
    )
    golden.to_csv(tmp_path / "reproduction.csv", index=False)
    for name in ("b.svg", "a.svg", "a.png"):
        (tmp_path / name).touch()
    print_reproduction.main(tmp_path / "reproduction.csv", tmp_path)
    assert (
        capsys.readouterr().out
        == REPRODUCTION + f"Figures: a.svg, b.svg in {tmp_path}\n"
    )


@pytest.mark.parametrize(
    ("script", "arguments", "told"),
    [
        ("print_reproduction", ["none.csv", "figures"], "reproduction: "),
        ("codecheck", [], "codecheck: "),
    ],
)
def test_a_script_that_make_runs_says_in_one_line_which_file_is_missing(
    tmp_path, script, arguments, told
):
    done = call(script, tmp_path, *arguments)
    assert (done.returncode, done.stdout, done.stderr.count("\n")) == (1, "", 1)
    assert done.stderr.startswith(told)
    assert arguments[:1] == [] or arguments[0] in done.stderr


def test_numbers_are_as_kept_to_a_millionth_and_pictures_if_they_look_the_same(
    tmp_path, monkeypatch, capsys
):
    golden, results, files = tmp_path / "tests/golden", tmp_path / "results", []
    golden.mkdir(parents=True)
    results.mkdir()
    for i, value in enumerate((1.0 + 0.9e-6, 1.0 + 1.2e-6, 0.9e-9, 1.2e-9)):
        files.append(f"{i}.csv")
        for directory, number in ((results, value), (golden, float(round(value)))):
            pd.DataFrame({"x": [number]}).to_csv(directory / files[-1], index=False)
    for i, (shade, rows) in enumerate(((0.518, 8), (0.525, 8), (0.5, 7))):
        files.append(f"{i}.png")
        image.imsave(golden / files[-1], np.full((8, 8, 3), 0.5))
        image.imsave(results / files[-1], np.full((rows, 8, 3), shade))
    listed = [{"file": f"results/{file}"} for file in files]
    (tmp_path / "codecheck.yml").write_text(json.dumps({"manifest": listed}))
    monkeypatch.chdir(tmp_path)
    assert codecheck.manifest() == [entry["file"] for entry in listed]
    with pytest.raises(SystemExit) as ended:
        codecheck.main()
    *lines, total = capsys.readouterr().out.splitlines()
    as_kept = [line.endswith(": as kept") for line in lines]
    assert as_kept == [True, False, True, False, True, False, False]
    assert lines[5].endswith("1.png: another picture")
    assert (ended.value.code, total) == (True, "3 of 7 files as kept")


# Proofs


@pytest.fixture(scope="module")
def committed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("committed") / "pair.json.gz"
    certify(PAIR, DURATION).save(path)
    return path


def test_a_fitting_certificate_is_taken_over_and_another_chain_or_duration_is_proved(
    committed, tmp_path
):
    chains = {
        "same": (PAIR, DURATION),
        "shorter": (PAIR, 0.3),
        "other": (dataclasses.replace(PAIR, mu_k="0.4"), 0.5),
    }
    outputs = [tmp_path / f"{name}.json.gz" for name in chains]
    params = Named(chains=[chain.as_text() for chain, _ in chains.values()])
    params.durations = [duration for _, duration in chains.values()]
    job = {"input": Named(committed=[committed]), "params": params}
    run_script("take_certificates", tmp_path, output=Named(*outputs), **job)
    certificates = map(Certificate.load, outputs)
    assert [(each.chain, float(each.duration)) for each in certificates] == [
        *chains.values()
    ]
    taken = [output.read_bytes() == committed.read_bytes() for output in outputs]
    assert taken == [True, False, False]


def test_a_certificate_is_proved_again(committed: Path, tmp_path: Path) -> None:
    job = {
        "input": Named(certificate=committed),
        "output": Named(table=tmp_path / "pair.csv"),
    }
    run_script("prove_again", tmp_path, **job)
    row = pd.read_csv(tmp_path / "pair.csv").iloc[0]
    assert (row["chain"], row["transitions"]) == (
        "pair",
        len(Certificate.load(committed).transitions),
    )
    assert 0.0 <= row["cpu_s"] < 60.0


# Tables


def test_the_tables_hold_what_is_proved_and_what_the_solver_gets_right(
    committed: Path,
) -> None:
    certificate = Certificate.load(committed)
    effort = pd.DataFrame({"chain": ["else"], "transitions": [1], "cpu_s": [1.0]})
    tables = proof_tables({"pair": certificate}, effort, 1e-9)
    row, facts = tables["certificates"].iloc[0], tables["solver_vs_proof"].iloc[0]
    assert row["transitions"] == len(certificate.transitions)
    assert row["largest_time_width_s"] == float(
        2 * max(t.time.radius for t in certificate.transitions)
    )
    assert pd.isna(
        row["cpu_s"]
    )  # the time of another proof is not taken for that of this one
    assert (
        facts["agreeing_transitions"]
        == facts["transitions"]
        == len(certificate.transitions)
    )
    assert (
        facts["horizon_s"] == facts["right_until_s"] == facts["duration_s"] == DURATION
    )
    assert (
        tables["horizon"]["actual_error_s"].iloc[-1]
        == facts["time_error_while_agreeing_s"]
    )


def test_methods_are_measured_to_the_first_global_slip(monkeypatch):
    values = {"exact": [0.0], "leapfrog": [1e-6, 1e-7]}
    monkeypatch.setattr(work_precision, "charted_values", lambda _full: values)
    certificate = certify(ExactChain.from_slider(n_blocks=2, theta="1/4"), 6.0)
    table = work_precision.work_precision_table(certificate, "two", False)
    assert table["method"].tolist() == ["exact", "leapfrog", "leapfrog"]
    assert set(table["scene"]) == {"two"}
    exact, coarse, fine = table.to_dict("records")
    assert exact["transitions_right"] == exact["transitions_true"]
    assert 0 < exact["transitions_true"] < len(certificate.transitions)
    assert 0 < exact["error_time_s"] < fine["error_time_s"] < coarse["error_time_s"]


def test_a_scene_without_an_exponent_has_an_empty_row():
    sliders = {"alone": {"theta": 0.0, "n_blocks": 1, "drive_velocity": 0.02}}
    sliders["ten"] = {"theta": 0.5, "drive_velocity": 0.002}
    table = lyapunov_table(sliders, 2.0).set_index("scene")
    assert table["theta"].to_dict() == {"alone": 0.0, "ten": 0.5}
    assert table.loc["alone"].drop("theta").isna().all()
    assert table.loc["ten"].notna().all()
    assert table.loc["ten", "uncertainty_per_s"] > 0
