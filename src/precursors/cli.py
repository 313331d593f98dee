"""The command `precursors`: simulate, slips, plot, audit.

What a command needs is imported when it runs, so that `precursors --help` answers at
once.
"""

from __future__ import annotations

import argparse
import json
import os
import re
import sys
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from difflib import get_close_matches
from fractions import Fraction
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn

from precursors.support.files import check_writable, write_table

if TYPE_CHECKING:
    from precursors.solver.run import Run

DONE = 0
REFUSED = 1
WRONG_USE = 2
FILE = 3
NOT_INSTALLED = 4
INTERRUPTED = 130
EPILOG = """\
examples:
  precursors simulate --theta 5/6 --output run.h5     10 s of the paper's chain, summarised and saved
  precursors slips run.h5 --counted                   the events counted in Fig. 13
  precursors plot --weights loads.csv --width 85 --font-size 9 --output fig.pdf
  precursors audit results/runs/*.h5                  is each run a motion of the model?

exit codes:
  0    done
  1    a run file is damaged, a run does not hold, or a run reached its limit of transitions
  2    an option is wrong, or a value is out of range
  3    a file cannot be read or written
  4    a package that this needs is not installed
  130  interrupted (Ctrl-C)"""

# Arguments of `Chain.from_slider` that are options, their defaults there, and what they
# are.
CHAIN = {
    "normal_load": ("400", "total normal load F_Z [N]"),
    "mu_s": ("0.70", "coefficient of static friction"),
    "mu_k": ("0.45", "coefficient of kinetic friction"),
    "drive_stiffness": ("0.8e6", "stiffness K of the drive's spring [N/m]"),
    "drive_velocity": ("1e-4", "speed V of the drive [m/s]"),
    "slider_mass": ("0.012", "mass M of the slider [kg]"),
    "youngs_modulus": ("2.5e9", "Young's modulus E [Pa]"),
    "cross_section": ("1e-4", "cross section S [m^2]"),
    "length": ("0.1", "length L of the contact [m]"),
}
# Fields of `LargerChain`, what such a chain adds to the paper's.
LARGER = {
    "weakening_velocity": "velocity v_c over which friction falls to mu_k [m/s]",
    "relaxation_time": "relaxation time t_v of the material [s]",
    "viscosity": "viscosity of the dashpots between neighbours [N s/m], instead of t_v",
    "push_height": "height of the push above the interface [m]",
}
RUN = ("duration", "until", "max_transitions")
DURATION = 10.0  # s
FIRST_SLIP = """\
mu_sapp = {mu_sapp:.3f} = {largest_load_N:.1f} N / {F_Z:g} N; first global slip at {global_slip_s:.3f} s.
"""


class Refused(Exception):
    """What the user asked for does not hold, or was not reached: each argument is a
    line."""


def simulate(arguments: argparse.Namespace) -> None:
    """Run a chain, and print a sentence and a summary."""
    from precursors.analysis.slips import apparent_friction, slip_table

    run = run_of_options(arguments)
    table = slip_table(run)
    first = apparent_friction(table)
    values: dict[str, Any] = {
        "blocks": run.chain.n_blocks,
        "duration_s": run.duration,
        "transitions": len(run.transitions),
        "events": first.event if first else len(table),
        "events_counted": int(table["counted"].sum()),
        "mu_sapp": first and first.mu_sapp,
        "largest_load_N": first and first.load,
        "global_slip_s": first and first.time,
        "global_slip_end_s": first and table["end_s"].iloc[first.event - 1],
    }
    if arguments.output:
        run.save(arguments.output)
        values["output"] = str(arguments.output)
    if not arguments.json:
        found = "{events_counted} events counted in Fig. 13, {events} in all; "
        found += FIRST_SLIP if first else "no global slip in {duration_s:g} s.\n"
        print(found.format(**values, F_Z=run.chain.normal_load))
    show_values(values, arguments.json)


def slips(arguments: argparse.Namespace) -> None:
    """List the slip events of a run file, or of a chain that is run."""
    from precursors.analysis.slips import slip_table

    table = slip_table(run_of(arguments))
    if arguments.counted:
        table = table[table["counted"]]
    if arguments.output:
        write_table(table, arguments.output)
    if arguments.json:
        found = table.astype(object).where(table.notna(), None)
        print(json.dumps(found.to_dict(orient="records"), indent=1))
    elif arguments.output:
        print(f"{len(table)} events: {arguments.output}")
    elif table.empty:
        print("no slip event")
    else:
        shown = table.drop(columns=["theta", "n_blocks", "normal_load_N", "length_m"])
        shown.columns = shown.columns.str.replace("load_|is_|n_", "", regex=True)
        print(shown.to_string(index=False, na_rep="-", float_format="{:.8g}".format))


def plot(arguments: argparse.Namespace) -> None:
    """Draw a run: its load and slips over time, or its propagation lengths against the
    load."""
    from precursors.analysis.load_curve import load_trace
    from precursors.analysis.slips import slip_table
    from precursors.figures import precursor_lengths, scene, style
    from precursors.model.spreadsheet import read_columns

    look = style.Look(arguments.width, arguments.font_size, arguments.font)
    columns = (
        ["F_X [N]", "L_p/L [-]"]
        if arguments.figure == "lengths"
        else ["t [s]", "F_X [N]"]
    )
    data = (
        read_columns(arguments.data, columns, exactly=True) if arguments.data else None
    )
    run = run_of(arguments)
    slips = slip_table(run)
    if arguments.figure == "lengths":
        figure = precursor_lengths.draw(
            [slips], data=data, title=arguments.title, look=look
        )
    else:
        trace = load_trace(run)
        title = (
            f"N = {run.chain.n_blocks}" if arguments.title is None else arguments.title
        )
        figure = scene.draw(
            slips, trace, title, data=data, inset=arguments.inset, look=look
        )
    style.save(figure, arguments.output, look)
    show_values({"output": str(arguments.output.resolve())}, arguments.json)


def audit(arguments: argparse.Namespace) -> None:
    """Check that each run file is whole and its run a motion of the model."""
    from precursors.audit import audit

    wrong: list[str] = []
    for path in arguments.files:
        try:
            run = load(path)
            if problems := audit(run).problems:
                raise Refused(f"{path}: not a motion of the model: {problems[0]}")
            print(
                f"{path}: a motion of the model, {len(run.transitions)} transitions in {run.duration:g} s"
            )
        except Refused as refused:
            wrong += refused.args
    if wrong:
        raise Refused(*wrong)


def load(path: Path) -> Run:
    """Read a run file."""
    from precursors.solver.run import Run, RunFileError

    try:
        return Run.load(path)
    except RunFileError as error:
        raise Refused(str(error)) from error


def run_of(arguments: argparse.Namespace) -> Run:
    """Read the run file, or run the chain of the options."""
    if arguments.file is None:
        return run_of_options(arguments)
    if given(arguments, ("theta", "n_blocks", "weights", *CHAIN, *LARGER, *RUN)):
        raise ValueError(
            f"{arguments.file}: a run file cannot be combined with options of a chain"
        )
    return load(arguments.file)


def run_of_options(arguments: argparse.Namespace) -> Run:
    """Run the chain of the options."""
    from precursors.model.chain import Chain, parse_theta
    from precursors.model.scenes import SLIDER, measured
    from precursors.solver.simulate import TransitionLimitError, simulate

    slider = given(arguments, ("theta", "n_blocks", *CHAIN))
    if arguments.weights is None:
        slider = {
            name: slider.get(name, default)
            for name, default in SLIDER.items()
            if name != "weights"
        }
        slider["theta"] = parse_theta(slider["theta"])
    elif slider.keys() & {"theta", "n_blocks", "normal_load"}:
        raise ValueError(
            "--weights cannot be combined with --theta, --blocks or --normal-load"
        )
    else:
        slider = measured(SLIDER | slider, arguments.weights)
    chain = Chain.from_slider(**slider)
    added = given(arguments, LARGER)
    how = {"duration": DURATION, **given(arguments, RUN)}
    try:
        if any(added.values()):
            from precursors.hierarchy.larger import LargerChain, simulate_with_accuracy

            run = simulate_with_accuracy(LargerChain(chain, **added), **how)
        else:
            run = simulate(chain, **how)
    except TransitionLimitError as error:
        if arguments.command != "simulate" or not arguments.output:
            raise Refused(str(error)) from error
        replace(error.run, slider=slider).save(arguments.output)
        raise Refused(f"{error}; the run so far is in {arguments.output}") from error
    return replace(run, slider=slider)


def given(arguments: argparse.Namespace, names: Iterable[str]) -> dict[str, Any]:
    """Options that were given, of those named."""
    return {
        name: value for name in names if (value := getattr(arguments, name)) is not None
    }


def announce_compiling() -> None:
    """Tell whoever uses the solver for the first time why it takes so long."""
    from numba.core import event

    from precursors.solver.kernel.compiled import Announcement

    event.register("numba:compile", Announcement())


def show_values(values: Mapping[str, Any], as_json: bool) -> None:
    """Print named values, one a line, ten digits a number; JSON has null for NaN."""
    values = {
        name: None if value != value else value for name, value in values.items()
    }  # NaN
    if as_json:
        print(json.dumps(values, indent=1))
        return
    width = max(map(len, values))
    for name, value in values.items():
        text = f"{value:.10g}" if isinstance(value, float) else value
        print(f"{name:<{width}}  {'-' if text is None else text}")


def number(text: str) -> float:
    """Read a number, or a fraction such as 5/6."""
    try:
        return float(Fraction(text)) if "/" in text else float(text)
    except (ValueError, ArithmeticError):
        raise argparse.ArgumentTypeError(
            f"{text!r} is not a number or a fraction such as 5/6"
        ) from None


def add_chain(command: argparse.ArgumentParser, is_shown: bool) -> None:
    """Add the options of a chain and of its run."""

    def group(title: str, about: str) -> Callable[..., object]:
        options: Any = command.add_argument_group(title, about) if is_shown else command
        return lambda name, **how: options.add_argument(
            f"--{name.replace('_', '-')}",
            **how if is_shown else how | {"help": argparse.SUPPRESS},
        )

    add = group("the chain", "the defaults are the paper's")
    add(
        "theta",
        metavar="X",
        help='non-uniformity of the normal loading, for example "5/6" (0)',
    )
    add("blocks", dest="n_blocks", type=int, metavar="N", help="number of blocks (10)")
    add(
        "weights",
        metavar="FILE",
        help="normal loads [N]; replaces --theta, --blocks and --normal-load",
    )
    for name, (default, meaning) in CHAIN.items():
        add(name, type=number, metavar="X", help=f"{meaning} ({default})")
    add = group("a larger chain", "each adds to the paper's chain; 0 by default")
    for name, meaning in LARGER.items():
        add(name, type=number, metavar="X", help=meaning)
    add = group("the run", "from rest, with every spring at its natural length")
    add("duration", type=number, metavar="S", help=f"time to run [s] ({DURATION:g})")
    text = "stop at the end of the first global slip"
    add(
        "until_global_slip",
        dest="until",
        action="store_const",
        const="global slip",
        help=text,
    )
    add("max_transitions", type=int, metavar="N", help="limit of transitions")


def add_options(command: Parser, name: str, shows_all: bool = False) -> Parser:
    """Add the options of a command; those of a chain stand in the help of `simulate`
    only, or of all."""
    add = command.add_argument
    if name == "audit":
        add("files", nargs="+", type=Path, metavar="RUN.h5", help="a run file")
        return command
    output: dict[str, Any] = {"type": Path, "metavar": "FILE"}
    add_chain(command, is_shown=shows_all or name == "simulate")
    if name == "simulate":
        add("--output", help="save the run (HDF5)", **output)
    else:
        add(
            "file",
            nargs="?",
            type=Path,
            metavar="RUN.h5",
            help="a run file; else the options of a chain",
        )
        command.epilog = "The options of the chain and of its run are those of `precursors simulate --help`."
    if name == "slips":
        add("--counted", action="store_true", help="only the events counted in Fig. 13")
        add("--output", help="write the table with every digit (CSV)", **output)
    elif name == "plot":
        add(
            "--figure",
            choices=["load", "lengths"],
            default="load",
            help="as Fig. 10, or as Fig. 13",
        )
        add(
            "--data",
            metavar="FILE",
            help="measured t [s] and F_X [N], or F_X [N] and L_p/L, drawn over it",
        )
        add(
            "--width",
            type=number,
            metavar="MM",
            help="width of the figure [mm] (178, or 85 for lengths)",
        )
        add(
            "--font-size",
            type=number,
            default=8.0,
            metavar="PT",
            help="size of the text [pt] (8)",
        )
        add(
            "--font",
            default="DejaVu Sans",
            metavar="NAME",
            help="an installed font (DejaVu Sans)",
        )
        add("--title", metavar="TEXT", help="title of the figure")
        add(
            "--no-inset",
            dest="inset",
            action="store_false",
            help="without the magnified view",
        )
        add(
            "--output",
            default=Path("precursors.png"),
            help="PNG, SVG, PDF or EPS (precursors.png)",
            **output,
        )
    add("--json", action="store_true", help="print one JSON value")
    return command


COMMANDS: dict[str, tuple[Callable[[argparse.Namespace], None], str]] = {
    "simulate": (simulate, "run a chain and summarise it"),
    "slips": (slips, "list the slip events of a run"),
    "plot": (plot, "draw a run"),
    "audit": (
        audit,
        "check that runs are motions of the model, without the solver's code",
    ),
}


class Parser(argparse.ArgumentParser):
    """An argument parser that says in one line what is wrong, and what was probably
    meant."""

    def error(self, message: str) -> NoReturn:
        """Exit with one line on standard error."""
        message = message.replace(
            "ignored explicit argument", "takes no value, but has"
        )
        choices = re.findall(r"\w+", message.partition("choose from")[2])
        helps = [add_options(Parser(), name).format_help() for name in COMMANDS]
        known = choices or re.findall(r"--[a-z][a-z-]+", " ".join(helps))
        wrong = re.search(r"(?:arguments: |choice: ')([\w-]+)", message)
        near = get_close_matches(wrong[1] if wrong else "", known, 1)
        hint = "".join(f"; did you mean {option}?" for option in near)
        self.exit(WRONG_USE, f"{self.prog}: {message}{hint} (see {self.prog} --help)\n")


def print_version() -> None:
    """Print the version, and in a checkout the commit and its software hash
    identifiers."""
    from precursors.support.provenance import git_state

    print(f"precursors {version('precursors')}")
    if state := git_state(Path(__file__).parents[2]):
        print(
            f"commit {state['commit']}{', and files have changed since' if state['changed'] else ''}"
        )
        print(state["swh_revision"], state["swh_directory"], sep="\n")


def parser(shows_all: bool = False) -> Parser:
    """Build the parser of all commands."""
    raw = argparse.RawDescriptionHelpFormatter
    top = Parser(
        "precursors",
        description="Simulate stick-slip chains exactly.",
        epilog=EPILOG,
        formatter_class=raw,
    )
    top.add_argument(
        "--version", action="store_true", help="show version, commit and identifiers"
    )
    subparsers = top.add_subparsers(dest="command", metavar="COMMAND")
    for name, (run, meaning) in COMMANDS.items():
        command = subparsers.add_parser(
            name, help=meaning, description=f"{meaning[0].upper()}{meaning[1:]}."
        )
        add_options(command, name, shows_all)
        command.set_defaults(run=run)
    return top


def join_negative_values(argv: Iterable[str]) -> list[str]:
    """Write `--theta -5/6` as `--theta=-5/6`, because argparse takes -5/6 for an
    option."""
    joined: list[str] = []
    for argument in argv:
        if (
            joined
            and re.fullmatch(r"-[\d.][\d./eE+-]*", argument)
            and re.fullmatch(r"--[^=]+", joined[-1])
        ):
            joined[-1] += f"={argument}"
        else:
            joined.append(argument)
    return joined


def main(argv: Sequence[str] | None = None) -> int:
    """Run a command and return its exit code; an error is one line on standard
    error."""
    os.environ.setdefault(
        "OPENBLAS_NUM_THREADS", "1"
    )  # starting threads costs more than any matrix here
    completes = (
        "_ARGCOMPLETE" in os.environ
    )  # set by the shell when somebody presses Tab
    top = parser(shows_all=completes)
    if completes:
        import argcomplete

        argcomplete.autocomplete(top)
    arguments = top.parse_args(
        join_negative_values(sys.argv[1:] if argv is None else argv)
    )
    if arguments.command is None and not arguments.version:
        top.error(f"needed is one of {', '.join(COMMANDS)}")
    try:
        if getattr(arguments, "output", None):
            is_figure = arguments.command == "plot"
            check_writable(
                arguments.output, (".png", ".svg", ".pdf", ".eps") if is_figure else ()
            )
        if arguments.version:
            print_version()
        else:
            if arguments.command != "audit":  # which needs no compiler
                announce_compiling()
            arguments.run(arguments)
        if sys.stdout:  # None where it was closed
            sys.stdout.flush()
        return DONE
    except BrokenPipeError:  # the reader has enough, as in `precursors slips | head`
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return DONE
    except KeyboardInterrupt:
        code = INTERRUPTED
        lines = ["interrupted"]
    except Refused as error:
        code = REFUSED
        lines = list(error.args)
    except ModuleNotFoundError as error:
        code = NOT_INSTALLED
        lines = [f"{error}: install it to use this"]
    except (ValueError, MemoryError) as error:
        code = WRONG_USE
        lines = [str(error) or "not enough memory for so many blocks or runs"]
    except OSError as error:
        code = FILE
        lines = [
            f"{error.filename}: {error.strerror}" if error.filename else str(error)
        ]
    for line in lines:
        print(
            f"precursors {arguments.command}: {' '.join(line.split())}", file=sys.stderr
        )
    return code
