"""The command line: what each command prints and returns, one line for every error, a start at once."""

import inspect
import io
import json
import re
import signal
import subprocess
import sys
import time
from fractions import Fraction
from functools import partial
from importlib.metadata import version

import matplotlib
import pandas as pd
import pytest
from matplotlib import pyplot

from precursors import Chain, Run, find_precursors, find_slips, simulate
from precursors.accuracy.proof import ExactChain, certify
from precursors.cli import COMMANDS, main
from precursors.cli.arguments import CHAIN_NUMBERS
from precursors.cli.exit_codes import EXIT_CODES, ExitCode
from precursors.reproduction.ledger.claims import read_claims
from precursors.reproduction.ledger.judge import judge, to_table
from precursors.support.progress import SECONDS_BETWEEN, Progress

# A budget for the interpreter and argparse; with NumPy and pandas it is exceeded.
STARTUP = 0.3  # s
HEAVY = {"numpy", "numba", "pandas", "h5py", "matplotlib", "scipy", "bokeh"}
COMMAND = [sys.executable, "-m", "precursors"]


@pytest.fixture
def cli(capsys):
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


@pytest.fixture(scope="module")
def certificate(tmp_path_factory):
    pytest.importorskip("flint", reason="python-flint (the extra proof) is not installed")
    path = tmp_path_factory.mktemp("certificates") / "certificate.json.gz"
    certify(ExactChain.from_chain(Chain.from_slider(n_blocks=3)), 2).save(path)
    return path


# Start-up and help


def test_help_answers_at_once_and_loads_nothing_heavy():
    program = "from precursors.cli import main\ntry: main(['--help'])\nfinally: print(*sys.modules)"
    seconds = []
    for _ in range(5):
        start = time.perf_counter()
        told = subprocess.run(
            [sys.executable, "-c", f"import sys\n{program}"], capture_output=True, text=True, check=True
        )
        seconds.append(time.perf_counter() - start)
    assert not HEAVY & set(told.stdout.split())
    assert min(seconds) < STARTUP


@pytest.mark.parametrize("command", COMMANDS, ids=lambda module: module.NAME)
def test_every_command_has_help_with_examples_that_are_read(cli, command, monkeypatch):
    code, out, _ = cli(command.NAME, "--help")
    assert code == ExitCode.DONE
    examples = out.partition("examples:\n")[2].splitlines()
    assert examples
    for example in examples:
        monkeypatch.setattr(command, "run", lambda arguments: 17)
        name, *arguments = example.split()
        assert name == "precursors"
        assert cli(*arguments)[0] == 17


def test_the_help_states_every_exit_code(cli):
    _, out, _ = cli("--help")
    for code, meaning in EXIT_CODES.items():
        assert re.search(rf"^  {code.value} +{re.escape(meaning)}$", out, re.MULTILINE)
    assert set(EXIT_CODES) == set(ExitCode)


def test_the_help_states_the_defaults_of_the_library():
    parameters = inspect.signature(Chain.from_slider).parameters
    for _, name, default, _ in CHAIN_NUMBERS:
        assert float(default) == parameters[name].default
    assert {name for _, name, _, _ in CHAIN_NUMBERS} == parameters.keys() - {"theta", "n_blocks"}


# simulate


def test_simulate_tells_the_papers_numbers(cli):
    code, out, err = cli("simulate", "--theta", "-5/6")
    assert (code, err) == (ExitCode.DONE, "")
    values = dict(line.split() for line in out.splitlines())
    assert (values["events_kept"], values["transitions"]) == ("6", "1871")
    assert float(values["mu_sapp"]) == pytest.approx(0.4845, abs=5e-5)


def test_simulate_keeps_the_run_and_tells_machines_the_same(cli, tmp_path):
    code, out, _ = cli(
        "simulate", "--blocks", 5, "--mu-k", "1/3", "--duration", 4, "--output", tmp_path / "run.h5", "--json"
    )
    assert code == ExitCode.DONE
    told = json.loads(out)
    run = Run.load(tmp_path / "run.h5")
    assert run.chain == Chain.from_slider(n_blocks=5, mu_k=1 / 3)
    assert run.duration == told["duration_s"] == 4.0
    assert told["transitions"] == len(run.transitions)
    assert told["events_kept"] == len(find_precursors(find_slips(run)))


def test_simulate_stops_at_the_global_slip_if_it_is_told_to(cli):
    _, out, _ = cli("simulate", "--until-global-slip", "--json")
    told = json.loads(out)
    assert told["transitions"] == 216
    assert told["duration_s"] == pytest.approx(told["global_slip_end_s"])


def test_a_value_that_is_not_there_is_null_to_machines(cli):
    _, out, _ = cli("simulate", "--duration", 0.1, "--json")
    assert json.loads(out)["mu_sapp"] is None


def test_an_ensemble_has_a_row_a_chain_and_its_seed_decides_it(cli, tmp_path):
    def members(*more):
        code, out, _ = cli("simulate", "--ensemble", 20, "--until-global-slip", "--json", *more)
        assert code == ExitCode.DONE
        return pd.DataFrame(json.loads(out)["members"])

    rows = members("--noise", "1e-3", "--seed", 3)
    assert rows["member"].tolist() == list(range(1, 21))
    assert 0 < rows["mu_sapp"].std() < 1e-2
    pd.testing.assert_frame_equal(rows, members("--noise", "1e-3", "--seed", 3))
    assert not rows["mu_sapp"].equals(members("--noise", "1e-3", "--seed", 4)["mu_sapp"])
    path = tmp_path / "rows.csv"
    assert members("--noise", 0, "--output", path)["mu_sapp"].unique().size == 1
    assert len(pd.read_csv(path)) == 20


def test_an_ensemble_whose_runs_meet_the_cap_shows_how_far_they_came_and_is_refused(cli, monkeypatch):
    monkeypatch.setattr("precursors.solver.simulate.MAX_TRANSITIONS", 150)
    code, out, err = cli("simulate", "--ensemble", 3, "--noise", 0, "--json")
    assert code == ExitCode.REFUSED
    assert [row["transitions"] for row in json.loads(out)["members"]] == [150, 150, 150]
    assert re.fullmatch(r".*3 of 3 rows are of runs .* member 1: max_transitions = 150 reached .*\n", err)


# slips


def test_slips_lists_the_events_of_a_run_file(cli, run_file):
    code, out, _ = cli("slips", run_file, "--json")
    assert code == ExitCode.DONE
    rows = pd.DataFrame(json.loads(out))
    slips = find_slips(Run.load(run_file))
    assert rows["onset_s"].tolist() == slips["onset"].tolist()
    assert rows["is_global"].tolist() == slips["is_global"].tolist()


def test_slips_of_a_chain_may_be_those_of_fig_13_only_and_go_to_a_file(cli, tmp_path):
    path = tmp_path / "slips.csv"
    code, out, _ = cli("slips", "--theta=5/6", "--until-global-slip", "--kept", "--output", path)
    assert code == ExitCode.DONE
    assert str(path) in out
    assert pd.read_csv(path)["kept"].tolist() == [True] * 14


def test_a_reader_that_has_enough_is_no_error():
    command = subprocess.Popen(
        [*COMMAND, "slips", "--theta", "5/6"], stdout=subprocess.PIPE, stderr=subprocess.PIPE
    )
    command.stdout.close()
    assert command.stderr.read() == b""
    assert command.wait() == ExitCode.DONE


# plot


@pytest.mark.parametrize("figure", ["load", "lengths"])
def test_plot_without_a_display_writes_a_file_and_tells_where(cli, tmp_path, monkeypatch, figure):
    monkeypatch.chdir(tmp_path)
    matplotlib.use("agg")
    code, out, _ = cli("plot", "--theta", "5/6", "--blocks", 20, "--duration", 3, "--figure", figure)
    assert code == ExitCode.DONE
    assert out == f"no display: wrote {tmp_path / 'precursors.png'}\n"
    assert (tmp_path / "precursors.png").read_bytes().startswith(b"\x89PNG")


def test_plot_shows_the_figure_where_there_is_a_display(cli, tmp_path, monkeypatch):
    (tmp_path / "pretended.py").write_text(
        "from matplotlib.backends.backend_agg import FigureCanvasAgg\n"
        "from matplotlib.backend_bases import FigureManagerBase\n"
        "class FigureManager(FigureManagerBase):\n"
        "    @classmethod\n"
        "    def pyplot_show(cls, *, block=None):\n"
        "        import matplotlib.pyplot as plt\n"
        "        axes = plt.gcf().axes\n"
        "        print('shown', block, len(axes), axes[0].get_ylabel())\n"
        "class FigureCanvas(FigureCanvasAgg):\n"
        "    required_interactive_framework = 'headless'\n"  # a framework of which Matplotlib finds a display
        "    manager_class = FigureManager\n"
    )
    monkeypatch.chdir(tmp_path)
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.delenv("DISPLAY", raising=False)
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)
    before = matplotlib.get_backend()
    matplotlib.use("module://pretended")
    try:
        code, out, err = cli("plot", "--duration", "1")
    finally:
        pyplot.close("all")
        matplotlib.use(before)
    assert (code, err) == (ExitCode.DONE, "")
    assert out == "shown True 2 Tangential load $F_X$ [N]\n"
    assert not (tmp_path / "precursors.png").exists()


def test_plot_writes_the_file_that_is_asked_for(cli, run_file, tmp_path):
    code, out, _ = cli("plot", run_file, "--output", tmp_path / "figure.svg", "--json")
    assert code == ExitCode.DONE
    assert json.loads(out) == {"output": str(tmp_path / "figure.svg")}
    assert "<svg" in (tmp_path / "figure.svg").read_text()


# verify


def test_verify_lets_whole_files_pass(cli, run_file, certificate):
    code, out, err = cli("verify", run_file, certificate, "--recompute")
    assert (code, err) == (ExitCode.DONE, "")
    assert [line.split(":")[1].strip() for line in out.splitlines()] == ["holds", "holds"]


def test_verify_refuses_a_run_file_with_one_byte_changed(cli, run_file, tmp_path):
    content = bytearray(run_file.read_bytes())
    content[len(content) // 2] ^= 1
    altered = tmp_path / "altered.h5"
    altered.write_bytes(content)
    code, out, err = cli("verify", altered, run_file)
    assert code == ExitCode.REFUSED
    assert err.count("\n") == 1
    assert "refused: damaged" in err
    assert out.startswith(f"{run_file}: holds")  # it goes on after a file that is refused


def test_verify_refuses_a_run_that_is_sealed_but_no_motion(cli, tmp_path):
    run = simulate(Chain.from_slider(), 3.0)
    run.transitions["time"][100] += 1e-9
    run.save(tmp_path / "moved.h5")
    code, _, err = cli("verify", tmp_path / "moved.h5")
    assert code == ExitCode.REFUSED
    assert "refused: no motion of the model" in err


def test_verify_refuses_a_certificate_altered_in_one_digit(cli, certificate, tmp_path):
    import gzip

    text = gzip.decompress(certificate.read_bytes()).decode()
    digit = re.search(r'"\d\.\d{5}(\d)', text[text.index('"transitions"') :])
    place = text.index('"transitions"') + digit.start(1)
    altered = text[:place] + str((int(text[place]) + 1) % 10) + text[place + 1 :]
    (tmp_path / "altered.json.gz").write_bytes(gzip.compress(altered.encode()))
    code, _, err = cli("verify", tmp_path / "altered.json.gz")
    assert code == ExitCode.REFUSED
    assert "refused: was altered" in err


def test_verify_tells_machines_each_verdict(cli, run_file, tmp_path):
    (tmp_path / "text").write_text("no run")
    code, out, err = cli("verify", run_file, tmp_path / "text", tmp_path / "missing", "--json")
    assert (code, err) == (ExitCode.REFUSED, "")
    assert [verdict["holds"] for verdict in json.loads(out)] == [True, False, None]
    assert cli("verify", tmp_path / "missing")[0] == ExitCode.FILE


# bench and check


def test_bench_times_methods_beside_the_exact_one(cli):
    code, out, _ = cli("bench", "--methods", "rk4_located", "--rounds", 1, "--json")
    assert code == ExitCode.DONE
    exact, other = json.loads(out)
    assert (exact["method"], exact["times_slower"], exact["same_as_exact"]) == ("exact", 1.0, 216)
    assert other["method"] == "rk4_located"
    assert other["times_slower"] > 1
    assert other["same_as_exact"] == 216


def test_bench_names_the_methods_there_are(cli):
    _, out, _ = cli("bench", "--methods", "list", "--json")
    assert {"exact", "scipy_dop853"} <= set(json.loads(out))


@pytest.fixture
def results(tmp_path, monkeypatch):
    """A directory with one claim, a table that it is judged by, and the verdict that is expected."""
    (tmp_path / "claims.yaml").write_text(
        "- {id: order, where: Sect. 5, kind: result, statement: They grow., rule: increasing,"
        " evidence: {table: lengths, column: length}}\n"
    )
    (tmp_path / "lengths.csv").write_text("length\n1\n2\n")
    expected = to_table(judge(read_claims(tmp_path / "claims.yaml"), tmp_path))
    expected.to_csv(tmp_path / "expected.csv", index=False)
    monkeypatch.chdir(tmp_path)
    return ("check", "--claims", "claims.yaml", "--tables", ".", "--expected", "expected.csv")


def test_check_prints_the_ledger(cli, results):
    code, out, err = cli(*results)
    assert (code, err) == (ExitCode.DONE, "")
    assert "1 claims: 1 reproduced" in out
    assert "order" in out


def test_check_fails_when_a_result_is_falsified(cli, results, tmp_path):
    (tmp_path / "lengths.csv").write_text("length\n2\n1\n")
    code, out, err = cli(*results, "--json")
    assert code == ExitCode.REFUSED
    assert json.loads(out)["claims"][0]["verdict"] == "not reproduced"
    assert "order: verdict" in err


def test_the_version_is_told(cli):
    assert cli("--version") == (ExitCode.DONE, f"precursors {version('precursors')}\n", "")


# Errors


@pytest.mark.parametrize(
    ("arguments", "code", "about"),
    [
        ((), ExitCode.WRONG_USE, "COMMAND"),
        (("fly",), ExitCode.WRONG_USE, "'fly'"),
        (("simulate", "--theta", "2"), ExitCode.WRONG_USE, "-1 <= theta <= 1"),
        (("simulate", "--theta", "x"), ExitCode.WRONG_USE, "'x' is not a number"),
        (("simulate", "--blocks", "2.5"), ExitCode.WRONG_USE, "'2.5' is not a whole number"),
        (("simulate", "--mu-s", "1/0"), ExitCode.WRONG_USE, "'1/0' is not a number"),
        (("simulate", "--duration", "-1"), ExitCode.WRONG_USE, "duration > 0"),
        (("simulate", "--drive-velocity", "nan"), ExitCode.WRONG_USE, "not finite"),
        (("simulate", "--seed", "1"), ExitCode.WRONG_USE, "--ensemble"),
        (("simulate", "--ensemble", "0"), ExitCode.WRONG_USE, "ensemble = 0"),
        (("simulate", "--ensemble", "2", "--blocks", "0"), ExitCode.WRONG_USE, "n_blocks = 0"),
        (("simulate", "--ensemble", "2", "--duration", "0"), ExitCode.WRONG_USE, "duration > 0"),
        (("simulate", "--max-transitions", "9"), ExitCode.REFUSED, "max_transitions = 9 reached"),
        (("simulate", "--output", "/dev/null/run.h5"), ExitCode.FILE, "/dev/null/run.h5"),
        (("slips", "missing.h5"), ExitCode.FILE, "missing.h5: no such file"),
        (("slips", __file__), ExitCode.REFUSED, "not a run file"),
        (("slips", "run.h5", "--theta", "0"), ExitCode.WRONG_USE, "one or the other"),
        (("plot", "--duration", "1", "--output", "figure.doc"), ExitCode.WRONG_USE, ".png and .svg"),
        (("bench", "--methods", "magic"), ExitCode.WRONG_USE, "allowed are exact"),
        (("check", "--expected", "missing.csv"), ExitCode.FILE, "missing.csv"),
    ],
)
def test_an_error_is_one_line_that_names_what_is_wrong(cli, arguments, code, about):
    found, out, err = cli(*arguments)
    assert found == code
    assert out == ""
    assert err.count("\n") == 1
    assert err.startswith("precursors")
    assert about in err


def test_a_package_that_is_missing_is_named(cli, certificate, monkeypatch):
    monkeypatch.setitem(sys.modules, "flint", None)
    monkeypatch.delitem(sys.modules, "precursors.accuracy.proof.tube", raising=False)
    code, _, err = cli("verify", "--recompute", certificate)
    assert code == ExitCode.NOT_INSTALLED
    assert "flint" in err
    assert err.count("\n") == 1


def test_an_interrupt_is_one_line():
    # A shell without job control has SIGINT ignored in what it starts in the background; tests inherit that.
    program = (
        "import signal, sys; from precursors.cli import main\n"
        "signal.signal(signal.SIGINT, signal.default_int_handler)\n"
        "main(['simulate', '--duration', '1', '--json'])\n"
        "print('ready', flush=True)\n"
        "sys.exit(main(['simulate', '--duration', '1e6']))"
    )
    command = subprocess.Popen(
        [sys.executable, "-c", program], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    while command.stdout.readline() != "ready\n":  # everything is imported and compiled
        assert command.poll() is None
    time.sleep(0.2)
    command.send_signal(signal.SIGINT)
    out, err = command.communicate(timeout=20)
    assert command.returncode == ExitCode.INTERRUPTED
    assert (out, err) == ("", "precursors simulate: interrupted\n")


@pytest.mark.parametrize("fraction", ["-5/6", "5/6", "-.5", "-0.25", "1e-1"])
def test_theta_may_be_negative_and_a_fraction(cli, fraction, tmp_path):
    code, *_ = cli("simulate", "--theta", fraction, "--duration", 0.01, "--output", tmp_path / "run.h5")
    assert code == ExitCode.DONE
    expected = Chain.from_slider(theta=float(Fraction(fraction)))
    assert Run.load(tmp_path / "run.h5").chain == expected


# Progress


class Terminal(io.StringIO):
    """A text stream that says it is a terminal."""

    def isatty(self):
        return True


def test_a_bar_shows_what_is_done_and_is_gone_at_the_end():
    terminal = Terminal()
    with Progress("working", [1.0] * 4, stream=terminal, delay=0.0) as progress:
        progress(1)
        time.sleep(0.15)
        progress(3)
        time.sleep(0.15)
    written = terminal.getvalue()
    assert "] 100%" not in written
    assert "]  75%, 3 of 4 runs" in written
    assert written.endswith("\r\x1b[K")


def test_what_is_over_within_two_seconds_and_what_is_no_terminal_stay_clean():
    terminal, file = Terminal(), io.StringIO()
    with Progress("working", stream=terminal):
        time.sleep(0.05)
    with Progress("working", stream=file, delay=0.0):
        time.sleep(0.15)
    assert terminal.getvalue() == file.getvalue() == ""


def test_a_file_that_asks_for_it_has_a_line_now_and_then_and_one_at_the_end(monkeypatch):
    monkeypatch.setitem(SECONDS_BETWEEN, False, 0.05)
    file = io.StringIO()
    with Progress("maps", [1.0, 3.0], stream=file, delay=0.0, in_file=True) as progress:
        progress(1)
        time.sleep(0.12)
        progress(2)
    lines = file.getvalue().splitlines()
    assert len(lines) > 2
    assert lines[-2].startswith("maps [########......................]  25%, 1 of 2 runs")
    assert lines[-1].startswith("maps [##############################] 100%, 2 of 2 runs")
    assert "\r" not in file.getvalue()


def test_the_bar_counts_work_and_not_members_and_estimates_what_is_left(monkeypatch):
    progress = Progress("x", [1.0, 1.0, 2.0, 6.0])
    clock = iter([100.0, 200.0, 300.0])
    monkeypatch.setattr("precursors.support.progress.time.monotonic", lambda: next(clock))
    told = []
    for n_done, now in ((1, 150.0), (2, 200.0), (3, 300.0), (4, 400.0)):
        progress(n_done)
        told.append(progress.line(now).partition("] ")[2])
    assert told == [
        " 10%, 1 of 4 runs",
        " 20%, 2 of 4 runs, 800 s left",
        " 40%, 3 of 4 runs, 400 s left",
        "100%, 4 of 4 runs",
    ]


def test_without_work_the_bar_tells_the_time_taken():
    with Progress("reading", stream=io.StringIO()) as progress:
        assert progress.line(time.monotonic() + 3.0) == "reading 3 s"


def test_an_ensemble_draws_a_bar(cli, monkeypatch, tmp_path):
    terminal = Terminal()
    monkeypatch.setattr("precursors.cli.simulate.Progress", partial(Progress, stream=terminal, delay=0.0))
    monkeypatch.setattr("precursors.ensembles.study.BLOCKS_PER_BATCH", 50)
    code, *_ = cli("simulate", "--ensemble", 200, "--until-global-slip", "--output", tmp_path)
    assert code == ExitCode.FILE  # a directory; the bar was drawn before
    assert re.search(r"\rsimulating \[[#.]{30}\] +\d+%, \d+ of 200 runs", terminal.getvalue())
