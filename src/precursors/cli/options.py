"""The options of the command line."""

import argparse
import math
import re
from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from pathlib import Path
from typing import Any, NoReturn

from precursors.support.units import NAMES

WRONG_USE = 2
EPILOG = """\
examples:
  precursors simulate --theta 5/6 --output run.h5     10 s of the paper's chain, summarised and saved
  precursors slips run.h5 --counted                   the events counted in Fig. 13
  precursors plot --weights loads.csv --width 85 --font-size 9 --output fig.pdf
  precursors audit results/runs/*.h5                  is each run a motion of the model?
  precursors score mine.csv --problem uniform         how many of its transitions are right?

exit codes:
  0    done
  1    a run file is damaged, a run does not hold, or a run reached its limit of transitions
  2    an option is wrong, or a value is out of range
  3    a file cannot be read or written
  4    a package that this needs is not installed
  130  interrupted (Ctrl-C)"""

# Usage and meaning.
COMMANDS = {
    "simulate": ("[options]", "run a chain and summarise it"),
    "slips": ("[RUN.h5] [options]", "list the slip events of a run"),
    "plot": ("[RUN.h5] [options]", "draw a run"),
    "audit": (
        "RUN.h5 ...",
        "check that runs are motions of the model, without the solver's code",
    ),
    "score": (
        "MINE.csv --problem NAME [options]",
        "score a result file on a problem of docs/benchmark.md",
    ),
}
# Arguments of `Chain.from_slider` that are numbers.
CHAIN = {
    "normal_load": "total normal load F_Z [N]",
    "mu_s": "coefficient of static friction",
    "mu_k": "coefficient of kinetic friction",
    "drive_stiffness": "stiffness K of the drive's spring [N/m]",
    "drive_velocity": "speed V of the drive [m/s]",
    "slider_mass": "mass M of the slider [kg]",
    "youngs_modulus": "Young's modulus E [Pa]",
    "cross_section": "cross section S [m^2]",
    "length": "length L of the contact [m]",
}
RUN = ("duration", "until", "max_transitions")
# Of measured loads, and of measured values drawn over a run.
MEASURED = ("weights", "profile", "load_cells", "cell_spacing")
DATA = {
    "sample_rate": "samples per second [Hz] of a file of F_X alone",
    "data_start": "time in the file at which the run starts [s] (0)",
    "data_offset": "F_X in the file at no load [N] (0)",
}
SLIDER_OPTIONS = ("theta", "n_blocks", *CHAIN)


class Parser(argparse.ArgumentParser):
    """An argument parser that says in one line what is wrong."""

    def error(self, message: str) -> NoReturn:
        """Exit with one line on standard error."""
        self.exit(WRONG_USE, f"{self.prog}: {message} (see {self.prog} --help)\n")


def read_options(argv: Sequence[str]) -> argparse.Namespace:
    """Read the command and its options."""
    top = Parser(
        "precursors",
        usage="precursors COMMAND [options]",
        description="Simulate stick-slip chains exactly.",
        epilog=EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    top.add_argument(
        "--version", action="store_true", help="show version, commit and identifiers"
    )
    subparsers = top.add_subparsers(dest="command", metavar="COMMAND", prog=top.prog)
    for name, (usage, meaning) in COMMANDS.items():
        command = subparsers.add_parser(
            name,
            help=meaning,
            description=f"{meaning.capitalize()}.",
            usage=f"precursors {name} {usage}",
        )
        if name in argv:  # the defaults of the others are not read
            add_options(command, name)
    # argparse takes -5/6 for an option, and " -5/6" for a value.
    values = [re.sub(r"^-(?=[\d.])", " -", argument) for argument in argv]
    arguments = top.parse_args(values)
    if arguments.command == "plot" and arguments.output is None:
        is_wave = arguments.figure == "wave"
        arguments.output = Path("precursors.svg" if is_wave else "precursors.png")
    if arguments.version:
        arguments.command = "version"
    elif arguments.command is None:
        top.print_help()
        top.exit(WRONG_USE)
    return arguments


def add_options(command: Parser, name: str) -> None:
    """Add the options of a command."""
    add = command.add_argument
    if name == "audit":
        add("files", nargs="+", type=Path, metavar="RUN.h5", help="a run file")
        return
    if name == "score":
        add(
            "file",
            type=Path,
            metavar="MINE.csv",
            help="transitions as docs/benchmark.md asks for them",
        )
        add(
            "--problem",
            required=True,
            help="which of its problems they solve, for example uniform; any other word "
            "lists them",
        )
        add(
            "--ties",
            type=_number,
            default=0.0,
            metavar="S",
            help="rows no farther apart may stand in any order [s] (0)",
        )
    elif name == "simulate":
        add("--output", help="save the run (HDF5)", type=Path)
    else:
        add(
            "file",
            nargs="?",
            type=Path,
            metavar="RUN.h5",
            help="a run file; else the options of a chain",
        )
    if name == "slips":
        add("--counted", action="store_true", help="only the events counted in Fig. 13")
        add("--output", help="write every digit of it (CSV or TSV)", type=Path)
        add(
            "--decimal-comma",
            dest="decimal",
            action="store_const",
            const=",",
            default=".",
            help="write decimal commas",
        )
    elif name == "plot":
        add(
            "--output",
            help="PNG, SVG, PDF or EPS (precursors.png; precursors.svg of a wave)",
            type=Path,
        )
        _add_look(command)
    add("--json", action="store_true", help="print one JSON value")
    if name != "score":
        _add_chain(command)


def _add_chain(command: Parser) -> None:
    """Add the options of a chain and of its run."""
    from precursors.model.chain import CELL_SPACING, SLIDER

    chain = command.add_argument_group("the chain", "the defaults are the paper's")
    add = chain.add_argument
    add("--blocks", dest="n_blocks", type=_whole, help="number of blocks (10)")
    add_one = chain.add_mutually_exclusive_group().add_argument
    add_one(
        "--theta",
        type=str.strip,
        help='non-uniformity of the normal loading, for example "5/6" (0)',
    )
    add_one(
        "--weights",
        help="file of normal loads [N]; replaces --blocks and --normal-load, too",
    )
    add_one(
        "--profile",
        help="file with the shape of the normal load, a line a position, from the drive",
    )
    add_one(
        "--load-cells",
        nargs=2,
        type=_number,
        metavar=("A", "B"),
        help="readings [N], A at the drive; --normal-load is their sum",
    )
    add(
        "--columns",
        type=_choice,
        metavar="CHOICE",
        help='names of columns, or numbers where there are none: of --data "t=Time,F_X=Ft", '
        'of --weights "w=NAME", of --profile "p=NAME"',
    )
    add("--cell-spacing", type=_number, help=f"between them [m] ({CELL_SPACING:g})")
    _add_numbers(add, {name: f"{CHAIN[name]} ({SLIDER[name]:g})" for name in CHAIN})
    add = command.add_argument_group(
        "the run", "from rest, with every spring at its natural length"
    ).add_argument
    add("--duration", help="time to run [s] (10)", type=_number)
    add(
        "--until-global-slip",
        dest="until",
        action="store_const",
        const="global slip",
        help="stop at the end of the first global slip",
    )
    add("--max-transitions", type=_whole, help="limit of transitions")


def _add_look(command: Parser) -> None:
    """Add the options of a figure."""
    add = command.add_argument
    add(
        "--figure",
        choices=["load", "lengths", "push", "wave"],
        default="load",
        help="load over time as in Fig. 10 (default), lengths as in Fig. 13; of two "
        "precursors and the global slip: the push in the springs, or a wave, in slow "
        "motion (SVG)",
    )
    add(
        "--events",
        type=int,
        nargs="+",
        metavar="N",
        help="slip events whose push is drawn instead, from 1",
    )
    add(
        "--data",
        help="measured t [s] and F_X [N], or F_X [N] and L_p/L, drawn over it",
    )
    _add_numbers(add, DATA)
    add(
        "--width",
        dest="width_mm",
        type=_number,
        help="width of the figure [mm] (178, or 85 for lengths)",
    )
    add("--font-size", type=_number, help="size of the text [pt] (8)")
    add("--font", help="an installed font (DejaVu Sans)")
    add("--title", help="title of the figure")


def _add_numbers(add: Callable[..., Any], meanings: Mapping[str, str]) -> None:
    """Add options that take a number, by their names."""
    for name, meaning in meanings.items():
        add(f"--{name.replace('_', '-')}", help=meaning, type=_number)


def _choice(text: str) -> dict[str, str]:
    """Read names of columns by the symbols of what they are."""
    symbols = [kind.split()[0] for kind in NAMES]
    parts = re.split(rf"(?:^|,)\s*({'|'.join(symbols)})\s*=", text)
    chosen = {
        key: name.strip() for key, name in zip(parts[1::2], parts[2::2], strict=True)
    }
    if (
        parts[0]
        or not len(parts) == 1 + 2 * len(chosen) > 1
        or not all(chosen.values())
    ):
        raise argparse.ArgumentTypeError(
            f"{text!r} must be {' or '.join(symbols)}, = and the name of a column"
        )
    return chosen


def _whole(text: str) -> int:
    """Read a whole number."""
    if text.strip().lstrip("+-").isdecimal():
        return int(text)
    raise argparse.ArgumentTypeError(f"{text!r} is not a whole number")


def _number(text: str) -> float:
    """Read a number, or a fraction such as 5/6."""
    try:
        # Not Fraction("1e999999999"), which writes all digits.
        value = float(Fraction(text) if "/" in text else text)
        if math.isfinite(value) and "_" not in text:
            return value
    except (ValueError, ArithmeticError):
        pass
    raise argparse.ArgumentTypeError(
        f"{text!r} is not a number or a fraction such as 5/6"
    )
