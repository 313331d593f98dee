"""The command `precursors`: simulate, slips, plot, audit.

What a command needs is imported when it runs, so that `precursors --help` answers at once.
"""

from __future__ import annotations

import argparse
import json
import os
import re
import sys
from collections.abc import Callable, Iterable, Mapping, Sequence
from fractions import Fraction
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn

if TYPE_CHECKING:
    import pandas as pd

    from precursors.solver.run import Run

DONE, REFUSED, WRONG_USE, FILE, NOT_INSTALLED, INTERRUPTED = 0, 1, 2, 3, 4, 130
EPILOG = """\
examples:
  precursors simulate --theta 5/6                     10 s of the paper's chain, summarised
  precursors simulate --theta 5/6 --output run.h5     the same, and the run is saved
  precursors simulate --theta -5/6 --ensemble 1000 --noise 1e-3 --output ensemble.csv
  precursors slips run.h5 --counted                   the events counted in Fig. 13
  precursors plot --theta 5/6 --blocks 20             a figure, on the screen or in a file
  precursors audit results/runs/*.h5                  is each run a motion of the model?

exit codes:
  0    done
  1    a run file is damaged, a run does not hold, or a run reached its limit of transitions
  2    an option is wrong, or a value is out of range
  3    a file cannot be read or written
  4    a package that this needs is not installed
  130  interrupted (Ctrl-C)"""

# Option of the chain, argument of `Chain.from_slider`, its default there, and what it is.
CHAIN = (
    ("--normal-load", "normal_load", "400", "total normal load F_Z [N]"),
    ("--mu-s", "mu_s", "0.70", "coefficient of static friction"),
    ("--mu-k", "mu_k", "0.45", "coefficient of kinetic friction"),
    ("--drive-stiffness", "drive_stiffness", "0.8e6", "stiffness K of the drive's spring [N/m]"),
    ("--drive-velocity", "drive_velocity", "1e-4", "speed V of the drive [m/s]"),
    ("--slider-mass", "slider_mass", "0.012", "mass M of the slider [kg]"),
    ("--youngs-modulus", "youngs_modulus", "2.5e9", "Young's modulus E [Pa]"),
    ("--cross-section", "cross_section", "1e-4", "cross section S [m^2]"),
    ("--length", "length", "0.1", "length L of the contact [m]"),
)
# Columns of a summary, and the names under which they are shown.
SUMMARY = {
    "transitions": "transitions",
    "n_events": "events",
    "events_counted": "events_counted",
    "mu_sapp": "mu_sapp",
    "load": "largest_load_N",
    "time": "global_slip_s",
    "end": "global_slip_end_s",
}
DURATION = 10.0  # s
NOISE = 1e-3
ENSEMBLE_BATCH = 64  # runs that are in memory at once
FIGURE_FILE = Path("precursors.png")


class Refused(Exception):
    """A run does not hold or was cut short; the message says which and why."""


def simulate(arguments: argparse.Namespace) -> None:
    """Run a chain, or an ensemble of chains, and print its summary."""
    if arguments.ensemble is not None:
        simulate_ensemble(arguments)
        return
    if arguments.noise is not None or arguments.seed is not None:
        raise ValueError("--noise and --seed need --ensemble N")
    from precursors.analysis.summary import summarise

    run = run_of_options(arguments)
    summary = summarise([run])[0]
    values = {
        "blocks": run.chain.n_blocks,
        "duration_s": run.duration,
        **{label: summary[name].item() for name, label in SUMMARY.items()},
        "transitions": len(run.transitions),  # of the whole run; the summary ends with the first global slip
    }
    if arguments.output:
        run.save(arguments.output)
        values["output"] = str(arguments.output)
    show_values(values, arguments.json)


def simulate_ensemble(arguments: argparse.Namespace) -> None:
    """Run chains whose normal loads differ by uniform noise; one row for each chain."""
    if arguments.max_transitions is not None:
        raise ValueError("--max-transitions cannot be combined with --ensemble")
    from dataclasses import replace

    import numpy as np
    import pandas as pd

    from precursors.analysis.summary import summarise
    from precursors.model.chain import Chain
    from precursors.model.checks import not_negative, whole
    from precursors.solver.simulate import simulate_many

    count = whole("ensemble", arguments.ensemble, at_least=1)
    noise = not_negative("noise", NOISE if arguments.noise is None else arguments.noise, "1")
    rng = np.random.default_rng(whole("seed", arguments.seed or 0, at_least=0))
    chain = Chain.from_slider(**slider_of(arguments))
    noises = 1 + noise * rng.uniform(-1, 1, (count, chain.n_blocks))
    chains = [replace(chain, weights=chain.weights * of_one) for of_one in noises]
    rows = []
    for first in range(0, count, ENSEMBLE_BATCH):
        runs = simulate_many(chains[first : first + ENSEMBLE_BATCH], duration_of(arguments), arguments.until)
        rows.append(pd.DataFrame(summarise(runs))[list(SUMMARY)])
    table = pd.concat(rows, ignore_index=True).rename(columns=SUMMARY)
    table.insert(0, "member", np.arange(1, count + 1))
    give_table(table, arguments, "runs")


def slips(arguments: argparse.Namespace) -> None:
    """List the slip events of a run file, or of a chain that is run."""
    from precursors.analysis.slips import slip_table

    table = slip_table(run_of(arguments))
    if arguments.counted:
        table = table[table["counted"]]
    give_table(table, arguments, "events")


def plot(arguments: argparse.Namespace) -> None:
    """Draw a run: its load and slips over time, or its propagation lengths against the load."""
    from precursors.analysis.load_curve import load_trace
    from precursors.analysis.slips import slip_table
    from precursors.figures import precursor_lengths, scene, style
    from precursors.support.files import read_table

    data = read_table(arguments.data) if arguments.data else None
    run = run_of(arguments)
    slips = slip_table(run)
    if arguments.figure == "lengths":
        figure = precursor_lengths.draw([slips])
    else:
        trace = load_trace(run, tolerance=1e-3)  # [N]; half the points, and a page shows the same
        figure = scene.draw(slips, trace, f"N = {run.chain.n_blocks}", data=data)
    style.save(figure, arguments.output)
    show_values({"output": str(arguments.output.resolve())}, arguments.json)


def audit(arguments: argparse.Namespace) -> None:
    """Check that each run file is whole and its run a motion of the model."""
    from precursors.accuracy.audit import audit
    from precursors.solver.run import Run, RunFileError

    failed = 0
    for path in arguments.files:
        try:
            run = Run.load(path)
            problems = tuple(audit(run).problems)
        except RunFileError as error:
            problems = (str(error),)
        if problems:
            failed += 1
            print(f"{path}: not a motion of the model: {problems[0]}", file=sys.stderr)
        else:
            print(f"{path}: a motion of the model, {len(run.transitions)} transitions in {run.duration:g} s")
    if failed:
        raise Refused(f"{failed} of {len(arguments.files)} files do not hold a motion of the model")


def run_of(arguments: argparse.Namespace) -> Run:
    """Read the run file, or run the chain of the options."""
    if arguments.file is None:
        return run_of_options(arguments)
    options = {"duration", "until", "max_transitions"}
    if slider_of(arguments) or any(getattr(arguments, name) for name in options):
        raise ValueError(f"{arguments.file}: a run file cannot be combined with options of a chain")
    from precursors.solver.run import Run, RunFileError

    try:
        return Run.load(arguments.file)
    except RunFileError as error:
        raise Refused(str(error)) from error


def run_of_options(arguments: argparse.Namespace) -> Run:
    """Run the chain of the options."""
    from dataclasses import replace

    from precursors.model.chain import Chain, parse_theta
    from precursors.model.scenes import SLIDER
    from precursors.solver.simulate import MAX_TRANSITIONS, TransitionLimitError, simulate

    slider = SLIDER | slider_of(arguments)
    if slider["weights"] is None:
        slider["theta"] = parse_theta(slider["theta"])
        del slider["weights"]
    chain = Chain.from_slider(**slider)
    limit = MAX_TRANSITIONS if arguments.max_transitions is None else arguments.max_transitions
    try:
        run = simulate(chain, duration_of(arguments), arguments.until, max_transitions=limit)
    except TransitionLimitError as error:
        raise Refused(str(error)) from error
    return replace(run, slider=slider)


def slider_of(arguments: argparse.Namespace) -> dict[str, Any]:
    """Arguments of `Chain.from_slider` that were given."""
    from precursors.model.scenes import measured

    names = ("theta", "n_blocks", *(name for _, name, _, _ in CHAIN))
    given = {name: getattr(arguments, name) for name in names if getattr(arguments, name) is not None}
    if arguments.weights is None:
        return given
    if given.keys() & {"theta", "n_blocks", "normal_load"}:
        raise ValueError("--weights cannot be combined with --theta, --blocks or --normal-load")
    return measured(given, arguments.weights)


def duration_of(arguments: argparse.Namespace) -> float:
    """Time to run [s]."""
    return DURATION if arguments.duration is None else arguments.duration


def show_values(values: Mapping[str, Any], as_json: bool) -> None:
    """Print named values, one a line, ten digits a number; JSON has null for NaN."""
    values = {name: None if value != value else value for name, value in values.items()}
    if as_json:
        print(json.dumps(values, indent=1))
        return
    width = max(map(len, values))
    for name, value in values.items():
        text = f"{value:.10g}" if isinstance(value, float) else value
        print(f"{name:<{width}}  {'-' if text is None else text}")


def give_table(table: pd.DataFrame, arguments: argparse.Namespace, rows: str) -> None:
    """Write a table to the file that was asked for, or print it, ten digits a number."""
    if arguments.output:
        from precursors.support.files import write_table

        write_table(table, arguments.output)
    if arguments.json:
        found = table.astype(object).where(table.notna(), None)
        print(json.dumps(found.to_dict(orient="records"), indent=1))
    elif arguments.output:
        print(f"{len(table)} {rows}: {arguments.output}")
    elif table.empty:
        print("no rows")
    else:
        print(table.to_string(index=False, na_rep="-", float_format="{:.10g}".format))


def number(text: str) -> float:
    """Read a number, or a fraction such as 5/6."""
    try:
        return float(Fraction(text)) if "/" in text else float(text)
    except (ValueError, ZeroDivisionError, OverflowError):
        raise argparse.ArgumentTypeError(f"{text!r} is not a number or a fraction such as 5/6") from None


def whole_number(text: str) -> int:
    """Read a whole number."""
    try:
        return int(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r} is not a whole number") from None


def add_chain(command: argparse.ArgumentParser) -> None:
    """Add the options of a chain and of its run; those that are not given are None."""
    add = command.add_argument_group("the chain", "the defaults are the paper's").add_argument
    add("--theta", metavar="X", help='non-uniformity of the normal loading, for example "5/6" (0)')
    add("--blocks", dest="n_blocks", type=whole_number, metavar="N", help="number of blocks (10)")
    add("--weights", metavar="FILE", help="normal load of each block [N], instead of the options above")
    for option, name, default, meaning in CHAIN:
        add(option, dest=name, type=number, metavar="X", help=f"{meaning} ({default})")
    add = command.add_argument_group("the run").add_argument
    add("--duration", type=number, metavar="S", help=f"time to run [s] ({DURATION:g})")
    help_ = "stop at the end of the first global slip"
    add("--until-global-slip", dest="until", action="store_const", const="global slip", help=help_)
    add("--max-transitions", type=whole_number, metavar="N", help="limit of transitions")


def add_options(command: argparse.ArgumentParser, name: str) -> None:
    """Add the options of a command."""
    output = partial(command.add_argument, "--output", type=Path, metavar="FILE")
    if name == "audit":
        command.add_argument("files", nargs="+", type=Path, metavar="RUN.h5", help="a run file")
        return
    if name != "simulate":
        command.add_argument("file", nargs="?", type=Path, metavar="RUN.h5", help="a run file")
    add_chain(command)
    if name == "simulate":
        add = command.add_argument_group("an ensemble").add_argument
        add("--ensemble", type=whole_number, metavar="N", help="run N chains that differ by noise")
        add("--noise", type=number, metavar="X", help=f"largest relative change of a load ({NOISE:g})")
        add("--seed", type=whole_number, metavar="N", help="seed of the noise (0)")
        output(help="save the run (HDF5) or the ensemble (CSV)")
    elif name == "slips":
        command.add_argument("--counted", action="store_true", help="only the events counted in Fig. 13")
        output(help="write the table with every digit (CSV)")
    else:
        kinds, meaning = ["load", "lengths"], "as Figs. 10 to 12 (load), or as Fig. 13 (lengths)"
        command.add_argument("--figure", choices=kinds, default="load", help=meaning)
        command.add_argument(
            "--data", metavar="FILE", help="draw a measured load over it: CSV with t [s], F_X [N]"
        )
        output(default=FIGURE_FILE, help=f"a .png, .svg, .pdf or .eps file ({FIGURE_FILE})")
    command.add_argument("--json", action="store_true", help="print one JSON value")


COMMANDS: dict[str, tuple[Callable[[argparse.Namespace], None], str]] = {
    "simulate": (simulate, "run a chain, or an ensemble of chains, and summarise it"),
    "slips": (slips, "list the slip events of a run"),
    "plot": (plot, "draw a run"),
    "audit": (audit, "check that runs are motions of the model, without the solver's code"),
}


class Parser(argparse.ArgumentParser):
    """An argument parser that says in one line what is wrong."""

    def error(self, message: str) -> NoReturn:
        """Exit with one line on standard error."""
        self.exit(WRONG_USE, f"{self.prog}: {message} (see {self.prog} --help)\n")


class PrintVersion(argparse.Action):
    """Look the version up only when it is asked for."""

    def __call__(self, parser: argparse.ArgumentParser, *_: object) -> NoReturn:
        """Print the version, and in a checkout the commit and its software hash identifiers."""
        from importlib.metadata import version

        from precursors.support.provenance import git_state

        print(f"precursors {version('precursors')}")
        if state := git_state(Path(__file__).parents[2]):
            print(f"commit {state['commit']}{', and files have changed since' if state['changed'] else ''}")
            print(state["swh_revision"], state["swh_directory"], sep="\n")
        parser.exit()


def parser() -> Parser:
    """Build the parser of all commands."""
    raw = argparse.RawDescriptionHelpFormatter
    top = Parser(
        "precursors", description="Simulate stick-slip chains exactly.", epilog=EPILOG, formatter_class=raw
    )
    top.add_argument("--version", action=PrintVersion, nargs=0, help="show version, commit and identifiers")
    subparsers = top.add_subparsers(dest="command", metavar="COMMAND", required=True)
    for name, (run, meaning) in COMMANDS.items():
        command = subparsers.add_parser(name, help=meaning, description=f"{meaning[0].upper()}{meaning[1:]}.")
        add_options(command, name)
        command.set_defaults(run=run)
    return top


def join_negative_values(argv: Iterable[str]) -> list[str]:
    """Write `--theta -5/6` as `--theta=-5/6`, because argparse takes -5/6 for an option."""
    joined: list[str] = []
    for argument in argv:
        if joined and re.fullmatch(r"-[\d.][\d./eE+-]*", argument) and re.fullmatch(r"--[^=]+", joined[-1]):
            joined[-1] += f"={argument}"
        else:
            joined.append(argument)
    return joined


def main(argv: Sequence[str] | None = None) -> int:
    """Run a command and return its exit code; an error is one line on standard error."""
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # starting threads costs more than any matrix here
    arguments = parser().parse_args(join_negative_values(sys.argv[1:] if argv is None else argv))
    try:
        arguments.run(arguments)
        sys.stdout.flush()
        return DONE
    except BrokenPipeError:  # the reader has enough, as in `precursors slips | head`
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return DONE
    except KeyboardInterrupt:
        code, message = INTERRUPTED, "interrupted"
    except (Refused, ArithmeticError) as error:
        code, message = REFUSED, str(error)
    except ModuleNotFoundError as error:
        code, message = NOT_INSTALLED, f"{error}: install it to use this"
    except (ValueError, MemoryError) as error:
        code, message = WRONG_USE, str(error) or "not enough memory for so many blocks or runs"
    except OSError as error:
        code, message = FILE, f"{error.filename}: {error.strerror}" if error.filename else str(error)
    except RuntimeError as error:  # a run reached its limit
        code, message = REFUSED, str(error)
    print(f"precursors {arguments.command}: {' '.join(message.split())}", file=sys.stderr)
    return code
