"""The command line: output and exit code of each command, errors of one line, and a
fast start."""

import inspect
import io
import json
import os
import re
import shlex
import signal
import subprocess
import sys
from dataclasses import replace
from importlib import import_module
from importlib.metadata import version
from pathlib import Path

import h5py
import numpy as np
import pandas as pd
import pytest
from matplotlib.text import Text
from places import ROOT

from precursors import Chain, Run, simulate
from precursors.analysis.slips import OF_SLIDER, slip_table
from precursors.cli import Refused, commands, main
from precursors.cli.options import CHAIN, EPILOG, read_options
from precursors.figures import style
from precursors.figures.run import plot

HEAVY = {"numpy", "numba", "pandas", "h5py", "matplotlib", "scipy"}
COMMAND = [sys.executable, "-m", "precursors"]  # which is precursors/__main__.py
CODES = [0, 1, 2, 3, 4, 130]
SEVEN_DIGITS = 5e-7  # relative error of printed numbers


@pytest.fixture(scope="session")
def _compiled():
    """Compile the solver, which would print a note on standard error."""
    simulate(Chain.from_slider(), 0.4).at([0.4])


@pytest.fixture
def cli(capsys, _compiled):
    """Run a command; return its exit code, standard output and standard error."""

    def run(*arguments):
        try:
            code = main([str(argument) for argument in arguments])
        except SystemExit as leaving:
            code = leaving.code
        return code, *capsys.readouterr()

    return run


@pytest.fixture(scope="module")
def run_file(tmp_path_factory):
    path = tmp_path_factory.mktemp("runs") / "run.h5"
    simulate(Chain.from_slider(), 3.0).save(path)
    return path


# Start-up and help


def test_help_imports_nothing_heavy_and_lists_exit_codes():
    program = (
        "import sys\nfrom precursors.cli import main\n"
        "try: main(['--help'])\nfinally: print(*sys.modules)"
    )
    process = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=True
    )
    assert not HEAVY & set(process.stdout.split())
    codes = process.stdout.partition("exit codes:")[2].splitlines()
    assert [int(line.split()[0]) for line in codes[1:7]] == CODES


def test_help_is_printed_without_a_command(cli):
    code, out, err = cli()
    assert (code, err) == (2, "")
    assert out.startswith("usage: precursors COMMAND [options]\n")


def test_help_of_a_command_states_the_library_defaults(cli):
    code, out, _ = cli("plot", "--help")
    out = " ".join(out.split())
    parameters = inspect.signature(Chain.from_slider).parameters
    for name, meaning in CHAIN.items():
        assert f"{meaning} ({parameters[name].default:g})" in out
    assert code == 0
    assert parameters.keys() - CHAIN.keys() == {"theta", "n_blocks", "weights"}


@pytest.mark.parametrize(
    "example", re.findall(r"^  precursors (.*?)(?:   .*)?$", EPILOG, re.MULTILINE)
)
def test_examples_in_the_help_are_valid(example):
    read_options(example.split())


def test_version_includes_the_commit_of_a_checkout(cli, monkeypatch):
    state = {"commit": "abc", "swh_revision": "rev", "swh_directory": "dir"}
    monkeypatch.setattr(
        commands,
        "git_state",
        lambda place: state | {"changed": True} if place == ROOT else None,
    )
    text = f"precursors {version('precursors')}\ncommit abc, and files have changed since\n"
    assert cli("--version") == (0, f"{text}rev\ndir\n", "")
    monkeypatch.setattr(commands, "git_state", lambda place: None)
    text = f"precursors {version('precursors')}\ncommit unknown: it was built without git\n"
    assert cli("--version") == (0, text, "")


# simulate

SUMMARY = """\
6 events counted in Fig. 13, of 7 up to the first global slip and 41 in 10 s.
mu_sapp = 0.484 = 193.8 N / 400 N; first global slip at 2.632 s.

n_blocks               10
duration_s             10
events_to_global_slip  7
events_counted         6
events_in_all          41
mu_sapp                0.4844519979
largest_load_N         193.7807992
global_slip_s          2.631997364
global_slip_end_s      2.632443711
global_slip_load_N     193.7807992
transitions            1871
"""


def test_simulate_prints_a_summary_and_the_output_path(cli, tmp_path):
    file = tmp_path / "run.h5"
    options = ("--theta", "-5/6", "--output", file)
    text = (
        f"{SUMMARY}output                 {file}\n\nprecursors plot {file} draws it\n"
    )
    assert cli("simulate", *options) == (0, text, "")
    values = json.loads(cli("simulate", "--theta=-5/6", "--json")[1])
    assert [f"{name} {value:.10g}" for name, value in values.items()] == [
        " ".join(line.split()) for line in SUMMARY.splitlines()[3:]
    ]
    out = cli("simulate", "--duration", 0.4)[1]
    assert out.startswith(
        "1 event counted in Fig. 13, of 1 in 0.4 s; no global slip.\n"
    )
    assert len(Run.load(file).transitions) == 1871


@pytest.mark.parametrize(
    ("options", "slider"),
    [
        (
            "--blocks 5 --theta -5/6 --mu-k 1/3",
            {"n_blocks": 5, "theta": -5 / 6, "mu_k": 1 / 3},
        ),
        (
            "--load-cells 300 100 --cell-spacing 0.1 --normal-load 200",
            {"theta": -0.5, "normal_load": 200.0},
        ),
        (
            "--profile p.csv --blocks 4 --normal-load 120 --header-line 2",
            {"weights": [10.0, 50.0, 20.0, 40.0]},
        ),
    ],
)
def test_simulate_runs_the_chain_given_by_options(
    cli, tmp_path, monkeypatch, options, slider
):
    monkeypatch.chdir(tmp_path)
    Path("p.csv").write_text("film 7\np [MPa]\n1\n5\n2\n4\n")
    cli("simulate", *options.split(), "--until-global-slip", "--output=run.h5")
    run = simulate(Chain.from_slider(**slider), until="global slip")
    assert Run.load("run.h5").chain == run.chain
    assert Run.load("run.h5").transitions.tolist() == run.transitions.tolist()


def test_simulate_saves_a_run_that_reaches_its_limit(cli, tmp_path):
    path = tmp_path / "run.h5"
    message = (
        "precursors simulate: max_transitions = 100 reached at t = 2.29058305 s of 10 s, "
        "last at block 4: raise max_transitions or shorten duration"
    )
    limited = ("simulate", "--max-transitions", 100)
    assert cli(*limited) == (1, "", f"{message}\n")
    saved = f"{message}; the run so far is in {path}\n"
    assert cli(*limited, "--output", path) == (1, "", saved)
    assert len(Run.load(path).transitions) == 100


# slips


def test_slips_prints_the_events_as_a_table(cli, run_file):
    code, out, err = cli("slips", run_file)
    assert (code, err) == (0, "")
    derived = ["largest_load_N", "front_length_m"]
    table = slip_table(Run.load(run_file)).drop(columns=[*OF_SLIDER, *derived])
    shown = pd.read_csv(io.StringIO(out), sep=r"\s+")
    pd.testing.assert_frame_equal(shown, table, rtol=SEVEN_DIGITS)
    assert max(map(len, out.splitlines())) < 100
    assert cli("slips", "--duration", 0.1) == (0, "no slip event\n", "")


@pytest.mark.parametrize(
    ("name", "options", "how"),
    [
        ("a.csv", [], {}),
        ("a.csv", ["--decimal-comma"], {"sep": ";", "decimal": ","}),
        ("a.tsv", [], {"sep": "\t"}),
    ],
)
def test_slips_writes_counted_events_for_a_spreadsheet(
    cli, run_file, tmp_path, name, options, how
):
    path = tmp_path / name
    command = ("slips", run_file, "--counted", *options, "--output", path)
    assert cli(*command) == (0, f"9 events: {path}\n", "")
    counted = slip_table(Run.load(run_file)).query("counted").reset_index(drop=True)
    pd.testing.assert_frame_equal(pd.read_csv(path, **how), counted)


def test_closed_output_pipe_is_no_error():
    with subprocess.Popen(
        [*COMMAND, "slips", "--theta", "5/6"],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
    ) as command:
        command.stdout.close()
        assert command.stderr.read() == b""
    assert command.returncode == 0


# plot


def test_ascii_terminal_can_print_a_unicode_file_name(run_file, tmp_path):
    path = tmp_path / "θ.png"
    done = subprocess.run(
        [*COMMAND, "plot", run_file, "--output", path],
        env=os.environ | {"PYTHONIOENCODING": "ascii"},
        capture_output=True,
    )
    assert (done.returncode, done.stderr) == (0, b"")
    assert done.stdout.endswith(rb"\u03b8.png" + os.linesep.encode())
    assert path.exists()


@pytest.mark.parametrize(
    ("options", "text", "err", "asked"),
    [
        ([], "", "", {}),
        (["--figure=push", "--events=2"], "", "", {"figure": "push", "events": [2]}),
        (
            ["--width=85", "--font-size=9", "--font=DejaVu Serif", "--title=Mine"],
            "t [s];F_X [N]\n0;0\n1,5;120,5\n",
            "data.csv: 2 points, t [s] 0 to 1.5, F_X [N] 0 to 120.5\n"
            "data.csv: 6.23 N rms from the run up to its first global slip\n",
            {"title": "Mine", "look": style.Look(85.0, 9.0, "DejaVu Serif")},
        ),
        (
            ["--figure=lengths"],
            "F_X [N];L_p/L\n100;0,5\n",
            "data.csv: 1 point, F_X [N] 100 to 100, L_p/L [-] 0.5 to 0.5\n"
            "data.csv: 0.0361 L rms from the run up to its first global slip\n",
            {"figure": "lengths"},
        ),
        (
            ["--figure=curve"],
            "t [s],F_X [N]\n0,-1\n1,-2\n",
            "data.csv: 2 points, t [s] 0 to 1, F_X [N] -2 to -1\n"
            "data.csv hardly overlaps the run: it reaches 0.01 times the largest F_X of the "
            "run (--data-start says when the run begins, --columns the units)\n"
            "data.csv: all of F_X is negative: is its sign reversed?\n"
            "data.csv: 55.5 N rms from the run up to its first global slip\n",
            {"figure": "curve"},
        ),
    ],
    ids=["load", "push", "look", "lengths", "curve"],
)
def test_plot_draws_the_same_figure_as_the_library(
    cli, run_file, tmp_path, monkeypatch, options, text, err, asked
):
    monkeypatch.chdir(tmp_path)
    if text:
        Path("data.csv").write_text(text)
        options = [*options, "--data=data.csv"]
        asked = asked | {"data": "data.csv"}
    out = f"output  {tmp_path / 'a.svg'}\n"
    assert cli("plot", run_file, *options, "--output=a.svg") == (0, out, err)
    look = asked.get("look", style.LOOK)
    style.save(plot(Run.load(run_file), **asked), "b.svg", look)
    assert Path("a.svg").read_bytes() == Path("b.svg").read_bytes()


def test_plot_without_a_run_file_runs_a_chain(cli, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    code, out, _ = cli(
        "plot", "--theta", "5/6", "--blocks", 3, "--duration", 0.5, "--json"
    )
    assert (code, json.loads(out)) == (0, {"output": str(tmp_path / "precursors.png")})
    assert Path("precursors.png").read_bytes().startswith(b"\x89PNG")


def test_measured_loads_are_shifted_to_start_and_offset(
    cli, run_file, tmp_path, monkeypatch
):
    monkeypatch.chdir(tmp_path)
    Path("F.csv").write_text("F_X [N]\n5\n5\n60\n70\n")
    notes = (
        "F.csv: 2 points, t [s] 0 to 0.5, F_X [N] 55 to 65\n"
        "F.csv: 42.9 N rms from the run up to its first global slip\n"
    )
    shift = ("--sample-rate=2", "--data-start=1", "--data-offset=5")
    assert cli("plot", run_file, "--data=F.csv", *shift)[::2] == (0, notes)
    code, _, err = cli("plot", run_file, "--data=F.csv", *shift[:1], "--data-start=9")
    assert (code, err) == (
        2,
        "precursors plot: F.csv ends before the start of the run\n",
    )


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        (
            "t [s],F_X [N]\n0,4000\n1,4500\n2,5000\n",
            "it reaches 26 times the largest F_X of the run",
        ),
        (
            "t [s],F_X [N]\n4,0\n5,0.1\n",
            "0 of its 2 times are within the run, and it",
        ),
    ],
)
def test_data_that_hardly_overlap_the_run_give_a_note(
    cli, run_file, tmp_path, monkeypatch, text, reason
):
    monkeypatch.chdir(tmp_path)
    Path("F.csv").write_text(text)
    code, _, err = cli("plot", run_file, "--data=F.csv")
    assert (code, err.count("\n")) == (0, 3)
    assert f"F.csv hardly overlaps the run: {reason}" in err
    assert "(--data-start says when" in err


def test_load_curve_and_front_lengths_are_drawn_with_names(
    cli, run_file, tmp_path, monkeypatch
):
    monkeypatch.chdir(tmp_path)
    Path("curve.csv").write_text("Zeit;F_X [N]\n1000;9\n2000;120\n")
    Path("film.csv").write_text("t [s];Front\n1,5;30\n2,9;60\n9;70\n")
    files = (
        "--data=curve.csv",
        "--data=film.csv",
        "--data-start=1",
        "--data-start=0.5",
    )
    chosen = ("--columns=t=Zeit [ms]", "--columns=L_p=Front [mm]")
    printed = (
        "curve.csv: 2 points, t [s] 0 to 1, F_X [N] 9 to 120\n"
        "film.csv: 3 points, t [s] 1 to 8.5, L_p/L [-] 0.3 to 0.7\n"
        "curve.csv: 31.4 N rms from the run up to its first global slip\n"
    )
    drawn = {}
    monkeypatch.setattr(style, "save", lambda figure, *_: drawn.update(figure=figure))
    for width in (60, 85, 120, 174):
        look = (f"--width={width}", "--font-size=9")
        assert cli("plot", run_file, *files, *chosen, *look)[::2] == (0, printed)
        figure = drawn["figure"]
        (key,) = figure.legends
        box = key.get_window_extent()
        assert box.x0 >= 0
        assert box.x1 <= figure.bbox.width
        assert box.y0 >= 0
        assert box.y1 < min(axes.get_tightbbox().y0 for axes in figure.axes)
        lines = figure.findobj(lambda a: getattr(a, "get_label", str)() == "film.csv")
        points = [
            line.get_xydata().tolist() for line in lines if len(line.get_xydata())
        ]
        assert [[1.0, 30.0], [2.4, 60.0], [8.5, 70.0]] in points
    code, _, err = cli("plot", run_file, *files, "--data=film.csv", *chosen)
    assert (code, err.count("\n")) == (2, 1)
    assert "--data-start must be given once, or once for each of 3 files, but is" in err


def test_measured_weights_are_echoed_and_named_in_figures(cli, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("loads.csv").write_text("Last;Ort\n30,0;1\n50,5;2\n40,0;3\n")
    chosen = "--columns=w=Last [N]"
    code, _, err = cli("simulate", "--weights=loads.csv", chosen, "--output=run.h5")
    assert (code, err) == (0, "loads.csv: 3 blocks, 30 to 50.5 N, F_Z = 120.5 N\n")
    run = Run.load("run.h5")
    for figure in (plot(run), plot(run, "lengths")):
        texts = {text.get_text() for text in figure.findobj(Text)}
        assert len([text for text in texts if "loads as measured" in text]) == 1


def test_global_slip_beyond_predictability_gives_a_note(cli):
    code, _, err = cli("slips", "--blocks", 50, "--until-global-slip")
    assert code == 0
    assert re.fullmatch(
        "the first global slip at 2.668 s is beyond predictability: "
        r"it depends on rounding from 2\.[0-6]\d\d s on\n",
        err,
    )


def test_light_block_that_changes_the_events_gives_a_note(cli, tmp_path):
    loads = tmp_path / "loads.csv"
    loads.write_text("50\n0.006\n50\n50\n")
    err = cli("simulate", "--weights", loads, "--duration", 2)[2]
    line = "block 2, with 0.006 N, keeps events from ending: 7 events, 10 without light blocks"
    assert line in err


# audit


def test_audit_refuses_a_damaged_file_and_a_moved_transition(cli, run_file, tmp_path):
    (tmp_path / "damaged.h5").write_bytes(run_file.read_bytes()[:-1000])
    code, out, err = cli("audit", tmp_path / "damaged.h5", run_file)
    assert (code, out) == (
        1,
        f"{run_file}: a motion of the model, 236 transitions in 3 s\n",
    )
    assert err.startswith(
        f"precursors audit: {tmp_path / 'damaged.h5'} is not a run file, or is damaged: "
    )
    run = Run.load(run_file)
    transitions = run.transitions.copy()
    transitions["time"][100] += 1e-9
    replace(run, transitions=transitions).save(tmp_path / "moved.h5")
    code, _, err = cli("audit", tmp_path / "moved.h5")
    assert (code, err.count("\n")) == (1, 1)
    assert err.startswith(
        f"precursors audit: {tmp_path / 'moved.h5'}: not a motion of the model: "
    )


def test_audit_notes_that_an_older_file_has_no_checksum(cli, run_file, tmp_path):
    old = tmp_path / "old.h5"
    old.write_bytes(run_file.read_bytes())
    with h5py.File(old, "r+") as file:
        file.attrs["format"] = np.bytes_(b"precursors run 6")
        del file.attrs["checksum"]
    code, out, err = cli("audit", old)
    assert (code, out.startswith(f"{old}: a motion of the model")) == (0, True)
    assert (
        err
        == f"{old} is an older file without a checksum: the length of its contact is not checked\n"
    )


def test_audit_that_reaches_its_work_limit_is_undecided(cli, run_file, monkeypatch):
    checks = import_module("precursors.audit.checks")
    monkeypatch.setattr(checks, "MAX_VALUES", 1000)
    code, out, err = cli("audit", run_file)
    assert (code, out) == (1, "")
    assert err.startswith(f"precursors audit: {run_file}: undecided: t = ")


# Errors


@pytest.mark.parametrize(
    ("arguments", "code", "about"),
    [
        (
            "simulate --output /dev/null/run.h5 --duration 1e9",
            3,
            "/dev/null is not a directory",
        ),
        ("slips --output a.xlsx --duration 1e9", 2, "must end in .csv or .tsv"),
        (
            "plot --duration 1e9 --output figure.doc",
            2,
            "must end in .png or .svg or .pdf or .eps",
        ),
        ("plot --duration 1e9 --font Helvetia", 2, "'Helvetia' is not installed"),
        ("simulate --mu-s 1/0", 2, "'1/0' is not a number"),
        (
            "simulate --weights w.csv --theta 0",
            2,
            "not allowed with argument --weights",
        ),
        ("simulate --cell-spacing 0", 2, "--cell-spacing needs --load-cells"),
        ("simulate --load-cells 1 2 --cell-spacing 0", 2, "spacing must be above 0"),
        ("simulate --weights ''", 3, "No such file or directory: ''"),
        ("simulate --profile ''", 3, "No such file or directory: ''"),
        ("plot --data ''", 3, "No such file or directory: ''"),
        ("simulate --columns w=F", 2, "--columns w=... needs --weights"),
        ("simulate --columns F", 2, "'F' is not of the form \"t=NAME [ms],F_X=NAME"),
        (
            "plot --columns time=Zeit,F_X=Kraft",
            2,
            "'time' must be one of t, F_X, L_p/L, L_p, w, x, p",
        ),
        ("plot --header-line 2", 2, "--header-line needs --data, --weights or"),
        ("plot --figure push --events 1_0", 2, "'1_0' is not a whole number"),
        (
            "simulate --blocks 1_0",
            2,
            "'1_0' is not a whole number (see precursors simulate",
        ),
        ("simulate --theta 0_1", 2, "theta must be a number between -1 and 1"),
        ("simulate --mu-k 0_1", 2, "'0_1' is not a number"),
        ("plot --data-start 1", 2, "--data is needed with data_start"),
        (
            "plot --figure lengths --data d.csv --data-start 1",
            2,
            "need --figure load or curve",
        ),
        ("simulate --weights missing.csv", 3, "missing.csv: No such file"),
        (f"slips {shlex.quote(__file__)}", 1, "run file"),
        ("slips run.h5 --duration 0", 2, "run.h5: a run file cannot be combined"),
        ("score a.csv --problem uni", 2, "uni: the problems are fast_drive, leading"),
        ("score /dev/zero --problem uniform", 3, "/dev/zero: it is not a regular file"),
        (
            "simulate --output /dev/null --duration 1e9",
            3,
            "/dev/null: it is not a file",
        ),
        ("score none.csv --problem uniform", 3, "none.csv: No such file"),
    ],
)
def test_error_is_one_line_that_names_what_is_wrong(cli, arguments, code, about):
    exit_code, out, err = cli(*shlex.split(arguments))
    assert (exit_code, out, err.count("\n")) == (code, "", 1)
    assert err.startswith("precursors")
    assert about in err


@pytest.mark.parametrize(
    ("error", "code", "message"),
    [
        (Refused("two\nlines"), 1, "two lines"),
        (ModuleNotFoundError("no 'flint'"), 4, "no 'flint': install it to use this"),
        (MemoryError(), 2, "not enough memory for so many blocks or runs"),
        (OSError(28, "No space left", "run.h5"), 3, "run.h5: No space left"),
    ],
)
def test_exception_gives_one_line_and_its_exit_code(
    cli, monkeypatch, error, code, message
):
    def fail(_):
        raise error

    monkeypatch.setattr(commands, "audit", fail)
    assert cli("audit", "run.h5") == (code, "", f"precursors audit: {message}\n")
    error = RuntimeError("of a library, which nobody expects")
    with pytest.raises(RuntimeError, match="nobody expects"):
        cli("audit", "run.h5")


def test_disabled_compiler_is_reported_in_one_line():
    process = subprocess.run(
        [*COMMAND, "simulate"],
        env=os.environ | {"NUMBA_DISABLE_JIT": "1"},
        capture_output=True,
        text=True,
    )
    assert (process.returncode, process.stderr) == (
        4,
        "precursors simulate: the solver must be compiled: unset NUMBA_DISABLE_JIT\n",
    )


def test_interrupt_stops_compiled_code():
    # A shell without job control has SIGINT ignored in what it starts in the
    # background; tests inherit that.
    program = (
        "import signal, sys; from precursors.cli import main; from precursors.solver import kernel\n"
        "signal.signal(signal.SIGINT, signal.default_int_handler)\n"
        "run_batch = kernel.run_batch\n"
        "kernel.run_batch = lambda *batch: (print('running', flush=True), run_batch(*batch))[1]\n"
        "sys.exit(main(['simulate', '--duration', '1e6']))"
    )
    command = subprocess.Popen(
        [sys.executable, "-c", program],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    assert command.stdout.readline() == "running\n"
    command.send_signal(signal.SIGINT)
    out, err = command.communicate(timeout=300)  # it takes far less unless it hangs
    assert command.returncode == 130
    assert set(out.splitlines()) <= {"running"}  # the kernel may be called again
    assert err == "precursors simulate: interrupted\n"


# score


def test_score_prints_a_sentence_and_every_number(cli, tmp_path):
    lines = ["time_s;block;mode;tangential_load_N", "0,35;1;1;28,0", ""]
    (tmp_path / "mine.csv").write_text("\n".join(lines))
    command = ("score", tmp_path / "mine.csv", "--problem", "uniform")
    line, _, *rows = cli(*command)[1].splitlines()
    assert line.startswith("uniform: 1 of 1428 transitions right, times within 2.2e-17")
    assert "it ends at 0.35 s, before the first global slip (true: 9 events" in line
    values = json.loads(cli(*command, "--json")[1])
    assert values["mu_sapp"] is None
    assert [row.split()[0] for row in rows] == list(values)
    assert rows[-1].split() == ["ends_s", "0.35"]
