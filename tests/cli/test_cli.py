"""The command line: what each command prints and returns, one line for every error, a start at once."""

import inspect
import json
import os
import re
import shlex
import signal
import subprocess
import sys
from fractions import Fraction
from importlib.metadata import version
from pathlib import Path

import pandas as pd
import pytest

from precursors import Chain, Run, find_precursors, find_slips, simulate
from precursors.cli import (
    CHAIN,
    COMMANDS,
    DONE,
    EPILOG,
    FILE,
    INTERRUPTED,
    REFUSED,
    WRONG_USE,
    join_negative_values,
    main,
    parser,
)
from precursors.support.provenance import git_state

HEAVY = {"numpy", "numba", "pandas", "h5py", "matplotlib", "scipy"}
COMMAND = [sys.executable, "-m", "precursors"]


@pytest.fixture(scope="session")
def _compiled():
    """The solver, which says so on standard error when it is compiled."""
    simulate(Chain.from_slider(), 0.4).at([0.4])


@pytest.fixture
def cli(capsys, _compiled):
    """Run a command; return its exit code, and what it wrote to standard output and standard error."""

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


def test_help_loads_nothing_heavy():
    program = (
        "import sys\nfrom precursors.cli import main\ntry: main(['--help'])\nfinally: print(*sys.modules)"
    )
    told = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert not HEAVY & set(told.stdout.split())


def test_the_options_of_a_chain_stand_once_in_the_help(cli):
    assert ["--theta" in cli(command, "--help")[1] for command in COMMANDS] == [True, False, False, False]


@pytest.mark.parametrize("example", re.findall(r"^  precursors (.*?)(?:   .*)?$", EPILOG, re.MULTILINE))
def test_the_examples_of_the_help_are_read(example):
    parser().parse_args(join_negative_values(example.split()))


def test_a_shell_completes_the_options_of_a_chain_for_every_command(tmp_path):
    line = "precursors plot --we"
    wanted = {"_ARGCOMPLETE": "1", "COMP_LINE": line, "COMP_POINT": str(len(line)), "_ARGCOMPLETE_IFS": " "}
    environment = os.environ | wanted | {"_ARGCOMPLETE_STDOUT_FILENAME": str(tmp_path / "told")}
    subprocess.run(COMMAND, env=environment, check=True)
    assert (tmp_path / "told").read_text().split() == ["--weights", "--weakening-velocity"]


def test_the_help_states_the_defaults_of_the_library():
    parameters = inspect.signature(Chain.from_slider).parameters
    for name, (default, _) in CHAIN.items():
        assert float(default) == parameters[name].default
    assert CHAIN.keys() == parameters.keys() - {"theta", "n_blocks", "weights"}


# simulate


def test_simulate_tells_the_papers_numbers(cli):
    code, out, err = cli("simulate", "--theta", "-5/6")
    assert (code, err) == (DONE, "")
    sentence, _, *lines = out.splitlines()
    assert sentence == (
        "6 events counted in Fig. 13, 7 in all; mu_sapp = 0.484 = 193.8 N / 400 N; "
        "first global slip at 2.632 s."
    )
    values = dict(line.split() for line in lines)
    assert (values["events_counted"], values["transitions"]) == ("6", "1871")
    assert float(values["mu_sapp"]) == pytest.approx(0.4845, abs=5e-5)


def test_simulate_keeps_the_run_and_tells_machines_the_same(cli, tmp_path):
    code, out, _ = cli(
        "simulate", "--blocks", 5, "--mu-k", "1/3", "--duration", 4, "--output", tmp_path / "run.h5", "--json"
    )
    assert code == DONE
    told = json.loads(out)
    run = Run.load(tmp_path / "run.h5")
    assert run.chain == Chain.from_slider(n_blocks=5, mu_k=1 / 3)
    assert run.duration == told["duration_s"] == 4.0
    assert told["transitions"] == len(run.transitions)
    assert told["events_counted"] == len(find_precursors(find_slips(run)))


def test_simulate_stops_at_the_global_slip_if_it_is_told_to(cli):
    _, out, _ = cli("simulate", "--until-global-slip", "--json")
    told = json.loads(out)
    assert told["transitions"] == 216
    assert told["duration_s"] == pytest.approx(told["global_slip_end_s"])


def test_a_run_without_a_global_slip_says_so(cli):
    _, out, _ = cli("simulate", "--duration", 0.1, "--json")
    assert json.loads(out)["mu_sapp"] is None
    assert "in all; no global slip in 0.1 s.\n" in cli("simulate", "--duration", 0.1)[1]


def test_a_run_that_meets_its_limit_is_kept_in_the_file_that_was_asked_for(cli, tmp_path):
    code, _, err = cli("simulate", "--max-transitions", 100, "--output", tmp_path / "run.h5")
    assert code == REFUSED
    assert str(tmp_path / "run.h5") in err
    assert len(Run.load(tmp_path / "run.h5").transitions) == 100


def test_a_command_whose_output_is_closed_ends_without_a_traceback():
    told = subprocess.run(f"{shlex.join(COMMAND)} simulate >&-", shell=True, capture_output=True, text=True)
    assert (told.returncode, told.stderr) == (DONE, "")


# slips


def test_slips_lists_the_events_of_a_run_file(cli, run_file):
    code, out, _ = cli("slips", run_file, "--json")
    assert code == DONE
    rows = pd.DataFrame(json.loads(out))
    slips = find_slips(Run.load(run_file))
    assert rows["onset_s"].tolist() == slips["onset"].tolist()
    assert rows["is_global"].tolist() == slips["is_global"].tolist()


def test_slips_of_a_chain_may_be_those_of_fig_13_only_and_go_to_a_file(cli, tmp_path):
    path = tmp_path / "slips.csv"
    code, out, _ = cli("slips", "--theta=5/6", "--until-global-slip", "--counted", "--output", path)
    assert code == DONE
    assert str(path) in out
    assert pd.read_csv(path)["counted"].tolist() == [True] * 14


@pytest.mark.parametrize("arguments", [["slips", "--theta", "5/6"], ["--version"]])
def test_a_reader_that_has_enough_is_no_error(arguments):
    command = subprocess.Popen([*COMMAND, *arguments], stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    command.stdout.close()
    assert command.stderr.read() == b""
    assert command.wait() == DONE


# plot


@pytest.mark.parametrize("figure", ["load", "lengths"])
def test_plot_writes_a_file_and_tells_where(cli, tmp_path, monkeypatch, figure):
    monkeypatch.chdir(tmp_path)
    code, out, _ = cli("plot", "--theta", "5/6", "--blocks", 20, "--duration", 3, "--figure", figure)
    assert code == 0
    assert out == f"output  {tmp_path / 'precursors.png'}\n"
    assert (tmp_path / "precursors.png").read_bytes().startswith(b"\x89PNG")


def test_plot_draws_as_it_is_told_to(cli, run_file, tmp_path):
    (tmp_path / "measured.csv").write_text("t;F\n0;0\n1,5;120,5\n")
    looks = ("--width=85", "--font-size=9", "--font=DejaVu Serif", "--title=Mine", "--no-inset")
    pictures = set()
    for options in ([], [f"--data={tmp_path / 'measured.csv'}"], *([look] for look in looks)):
        code, out, _ = cli("plot", run_file, *options, "--output", tmp_path / "figure.svg", "--json")
        assert (code, json.loads(out)) == (DONE, {"output": str(tmp_path / "figure.svg")})
        pictures.add((tmp_path / "figure.svg").read_text())
    assert len(pictures) == 2 + len(looks)


def test_slips_of_measured_normal_loads_are_those_of_the_same_linear_ones_without_theta(cli, tmp_path):
    (tmp_path / "loads.csv").write_text("block;load\n1;30,0\n2;40,0\n3;50,0\n")
    files = [tmp_path / "measured.csv", tmp_path / "linear.csv"]
    cli("slips", "--weights", tmp_path / "loads.csv", "--duration", 2, "--output", files[0])
    cli("slips", "--theta", 0.25, "--blocks", 3, "--normal-load", 120, "--duration", 2, "--output", files[1])
    measured, linear = map(pd.read_csv, files)
    assert measured["theta"].isna().all()
    assert len(measured) > 0
    pd.testing.assert_frame_equal(measured.drop(columns="theta"), linear.drop(columns="theta"))


# audit


def test_audit_refuses_a_damaged_file_and_lets_a_whole_run_pass(cli, run_file, tmp_path):
    (tmp_path / "damaged.h5").write_bytes(run_file.read_bytes()[:-1000])
    code, out, err = cli("audit", tmp_path / "damaged.h5", run_file)
    assert code == REFUSED
    why, summary = err.splitlines()
    assert "damaged.h5" in why
    assert summary == "precursors audit: 1 of 2 files do not hold a motion of the model"
    assert out.startswith(f"{run_file}: a motion of the model, ")
    assert cli("audit", tmp_path / "damaged.h5") == (REFUSED, "", f"precursors audit: {why}\n")


def test_audit_refuses_a_run_with_one_transition_moved_by_a_nanosecond(cli, tmp_path):
    run = simulate(Chain.from_slider(), 3.0)
    run.transitions["time"][100] += 1e-9
    run.save(tmp_path / "moved.h5")
    code, _, err = cli("audit", tmp_path / "moved.h5")
    assert code == REFUSED
    (line,) = err.splitlines()
    assert "moved.h5: not a motion of the model: t = " in line


def test_the_version_is_told(cli):
    code, printed, error = cli("--version")
    name, *commit = printed.splitlines()
    assert (code, name, error) == (DONE, f"precursors {version('precursors')}", "")
    state = git_state(Path(__file__).parents[2])
    assert commit[1:] == ([state["swh_revision"], state["swh_directory"]] if state else [])


# Errors


@pytest.mark.parametrize(
    ("arguments", "code", "about"),
    [
        ((), WRONG_USE, "needed is one of simulate"),
        (("fly",), WRONG_USE, "'fly'"),
        (("simulat",), WRONG_USE, "did you mean simulate?"),
        (("slips", "--thta", "0"), WRONG_USE, "did you mean --theta?"),
        (("plot", "--figure", "length"), WRONG_USE, "did you mean lengths?"),
        (("slips", "run.h5", "--duration", "0"), WRONG_USE, "cannot be combined"),
        (
            ("simulate", "--output", "/dev/null/run.h5", "--duration", "1e9"),
            FILE,
            "/dev/null is not a directory",
        ),
        (("plot", "--duration", "1e9", "--output", "figure.doc"), WRONG_USE, "must end in .png"),
        (("plot", "--duration", "1e9", "--width", "8.5"), WRONG_USE, "between 40 and 400 mm, but is 8.5"),
        (("plot", "--duration", "1e9", "--font-size", "90"), WRONG_USE, "between 4 and 24 pt, but is 90"),
        (("plot", "--duration", "1e9", "--font", "Helvetia"), WRONG_USE, "'Helvetia' is not installed"),
        (("plot", "--duration", "1e9", "--data", "missing.csv"), WRONG_USE, "missing.csv: no such file"),
        (("simulate", "--theta", "2"), WRONG_USE, "theta must be a number between -1 and 1"),
        (("simulate", "--theta", "x"), WRONG_USE, "theta must be a number between -1 and 1"),
        (("simulate", "--blocks", "2.5"), WRONG_USE, "invalid int value: '2.5'"),
        (("simulate", "--mu-s", "1/0"), WRONG_USE, "'1/0' is not a number"),
        (("simulate", "--duration", "-1"), WRONG_USE, "duration must be above 0 s"),
        (("simulate", "--drive-velocity", "nan"), WRONG_USE, "drive_velocity must be a finite number"),
        (
            ("simulate", "--blocks", "0"),
            WRONG_USE,
            "n_blocks must be a whole number from 1 to 100000",
        ),
        (("simulate", "--max-transitions", "9"), REFUSED, "max_transitions = 9 reached"),
        (("simulate", "--weights", "w.csv", "--theta", "0"), WRONG_USE, "cannot be combined with --theta"),
        (("simulate", "--weights", "missing.csv"), WRONG_USE, "missing.csv: no such file"),
        (("slips", "missing.h5"), FILE, "missing.h5: no such file"),
        (("slips", __file__), REFUSED, "run file"),
        (("slips", "run.h5", "--theta", "0"), WRONG_USE, "cannot be combined"),
    ],
)
def test_an_error_is_one_line_that_names_what_is_wrong(cli, arguments, code, about):
    found, out, err = cli(*arguments)
    assert found == code
    assert out == ""
    assert err.count("\n") == 1
    assert err.startswith("precursors")
    assert about in err


def test_an_interrupt_is_one_line():
    # A shell without job control has SIGINT ignored in what it starts in the background; tests inherit that.
    program = (
        "import signal, sys; from precursors.cli import main; from precursors.solver import kernel\n"
        "signal.signal(signal.SIGINT, signal.default_int_handler)\n"
        "run_batch = kernel.run_batch\n"
        "kernel.run_batch = lambda *batch: (print('running', flush=True), run_batch(*batch))[1]\n"
        "sys.exit(main(['simulate', '--duration', '1e6']))"
    )
    command = subprocess.Popen(
        [sys.executable, "-c", program], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    assert command.stdout.readline() == "running\n"
    command.send_signal(signal.SIGINT)
    out, err = command.communicate(timeout=300)  # far more than it takes, unless it hangs
    assert command.returncode == INTERRUPTED
    assert set(out.splitlines()) <= {"running"}  # some calls of the kernel more
    assert err == "precursors simulate: interrupted\n"


@pytest.mark.parametrize("fraction", ["-5/6", "5/6", "-.5", "-0.25", "1e-1"])
def test_theta_may_be_negative_and_a_fraction(cli, fraction, tmp_path):
    code, *_ = cli("simulate", "--theta", fraction, "--duration", 0.01, "--output", tmp_path / "run.h5")
    assert code == DONE
    expected = Chain.from_slider(theta=float(Fraction(fraction)))
    assert Run.load(tmp_path / "run.h5").chain == expected
