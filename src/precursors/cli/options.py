"""The options of the command line."""

import argparse
import math
import re
from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from pathlib import Path
from typing import Any, NoReturn

WRONG_USE = 2
EPILOG = """\
examples:
  precursors simulate --theta 5/6 --output run.h5     10 s of the paper's chain, summarised and saved
  precursors slips run.h5 --counted                   the events counted in Fig. 13
  precursors plot --weights loads.csv --width 85 --font-size 9 --output fig.pdf
  precursors audit results/runs/*.h5                  does each run obey the equations of the model?
  precursors score mine.csv --problem uniform         how many of its transitions are right?

exit codes:
  0    done
  1    a run file is damaged, a run fails the audit, or it reached its limit of transitions
  2    an option is wrong, or a value is out of range
  3    a file cannot be read or written
  4    a required package is not installed
  130  interrupted (Ctrl-C)"""

COMMANDS = {
    "simulate": ("[options]", "run a chain and summarise it"),
    "slips": ("[RUN.h5] [options]", "list the slip events of a run"),
    "plot": ("[RUN.h5] [options]", "draw a run"),
    "audit": (
        "RUN.h5 ...",
        "check that runs obey the equations of the model, independently of the solver",
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
# Options of measured normal loads, and of measured data to draw with a run.
MEASURED = ("weights", "profile", "load_cells", "cell_spacing")
DATA = {
    "sample_rate": "samples per second [Hz] of a file without times",
    "data_start": "time in the file at which the run starts [s] (0)",
    "data_offset": "F_X in the file at no load [N] (0)",
}
# Keys of --columns, and the symbols of `precursors.support.measured`.
COLUMNS = {
    "t": "t",
    "F_X": "F_X",
    "L_p/L": "L_p/L",
    "L_p": "L_p/L",
    "w": "w",
    "x": "x",
    "p": "p",
}
SLIDER_OPTIONS = ("theta", "n_blocks", *CHAIN)


class Parser(argparse.ArgumentParser):
    """An argument parser whose errors are one line."""

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
        if name in argv:  # options of other commands would load the model
            add_options(command, name)
    # argparse reads -5/6 as an option, but " -5/6" as a value.
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
            help="transitions in the format of docs/benchmark.md",
        )
        add(
            "--problem",
            required=True,
            help="problem that the file solves, for example uniform; an unknown name lists "
            "them all",
        )
        add(
            "--ties",
            type=_number,
            default=0.0,
            metavar="S",
            help="rows may be in any order if their times differ by at most this [s] (0)",
        )
    elif name == "simulate":
        add("--output", help="save the run (HDF5)", type=Path)
    else:
        add(
            "file",
            nargs="?",
            type=Path,
            metavar="RUN.h5",
            help="a run file; without it, the chain given by the options is run",
        )
    if name == "slips":
        add("--counted", action="store_true", help="only the events counted in Fig. 13")
        add("--output", help="save the table with all digits (CSV or TSV)", type=Path)
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
            help="PNG, SVG, PDF or EPS file (precursors.png, or precursors.svg for a wave)",
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
        help='non-uniformity of the normal load, for example "5/6" (0)',
    )
    add_one(
        "--weights",
        help="file with one normal load [N] per block; replaces --theta, --blocks and "
        "--normal-load",
    )
    add_one(
        "--profile",
        help="file with the pressure along the contact, at positions from the drive end or "
        "in equal cells",
    )
    add_one(
        "--load-cells",
        nargs=2,
        type=_number,
        metavar=("A", "B"),
        help="two load-cell readings [N], A at the drive end; the default of --normal-load "
        "is their sum",
    )
    add(
        "--columns",
        type=_choice,
        action="append",
        metavar="CHOICE",
        help="columns to read, by name or number, and their units: for --data "
        '"t=Zeit [ms],F_X=Kraft [kN]" or "L_p/L=3 [mm]", for --weights "w=2 [N]", for '
        '--profile "x=Ort [mm],p=Druck [MPa]"',
    )
    add(
        "--header-line",
        type=_whole,
        action="append",
        metavar="N",
        help="number of the line with the column names, counted from 1; with several files, "
        "give this option and --columns once for all files, or once for each: first for "
        "--weights or --profile, then for --data",
    )
    add(
        "--cell-spacing",
        type=_number,
        help=f"distance between the load cells [m] ({CELL_SPACING:g})",
    )
    _add_numbers(add, {name: f"{CHAIN[name]} ({SLIDER[name]:g})" for name in CHAIN})
    _add_run(command)


def _add_run(command: Parser) -> None:
    """Add the options that say when a run ends."""
    add = command.add_argument_group(
        "the run", "starts from rest, with every spring at its natural length"
    ).add_argument
    add("--duration", help="time to run [s] (10)", type=_number)
    add(
        "--until-global-slip",
        dest="until",
        action="store_const",
        const="global slip",
        help="stop at the end of the first global slip",
    )
    add("--max-transitions", type=_whole, help="largest number of transitions")


def _add_look(command: Parser) -> None:
    """Add the options of a figure."""
    add = command.add_argument
    add(
        "--figure",
        choices=["load", "curve", "lengths", "push", "wave"],
        default="load",
        help="load: load and slips over time as in Fig. 10 (default); curve: the load alone; "
        "lengths: front lengths as in Fig. 13; push: the spring forces before and after "
        "two precursors and the global slip; wave: these three events in slow motion "
        "(SVG)",
    )
    add(
        "--events",
        type=_whole,
        nargs="+",
        metavar="N",
        help="numbers, from 1, of the slip events to show with --figure push",
    )
    add(
        "--data",
        action="append",
        help="measured file to draw as well, with columns t [s] and F_X [N], t and L_p [mm], "
        "or F_X and L_p/L; may be repeated, with its options given once for all files or "
        "once for each",
    )
    _add_numbers(add, DATA, action="append")
    add(
        "--width",
        dest="width_mm",
        type=_number,
        help="width of the figure [mm] (178, or 85 for a curve or lengths)",
    )
    add("--font-size", type=_number, help="size of the text [pt] (8)")
    add("--font", help="an installed font (DejaVu Sans)")
    add("--title", help="title of the figure")


def _add_numbers(
    add: Callable[..., Any], meanings: Mapping[str, str], **how: Any
) -> None:
    """Add an option that takes a number for each name."""
    for name, meaning in meanings.items():
        add(f"--{name.replace('_', '-')}", help=meaning, type=_number, **how)


def _choice(text: str) -> dict[str, str]:
    """Read the columns chosen for each symbol."""
    begin, *parts = re.split(r"(?:^|,)\s*([^\s,=]+)\s*=", text)
    chosen = {
        COLUMNS.get(key, key): name.strip()
        for key, name in zip(parts[::2], parts[1::2], strict=True)
    }
    if begin or not len(parts) == 2 * len(chosen) > 0 or not all(chosen.values()):
        raise argparse.ArgumentTypeError(
            f'{text!r} is not of the form "t=NAME [ms],F_X=NAME [kN]"'
        )
    for key in chosen.keys() - COLUMNS.values():
        raise argparse.ArgumentTypeError(f"{key!r} must be one of {', '.join(COLUMNS)}")
    return chosen


def _whole(text: str) -> int:
    """Read a whole number."""
    if text.strip().lstrip("+-").isdecimal():
        return int(text)
    raise argparse.ArgumentTypeError(f"{text!r} is not a whole number")


def _number(text: str) -> float:
    """Read a number, or a fraction such as 5/6."""
    try:
        # Fraction("1e999999999") would write out all its digits.
        value = float(Fraction(text) if "/" in text else text)
        if math.isfinite(value) and "_" not in text:
            return value
    except (ValueError, ArithmeticError):
        pass
    raise argparse.ArgumentTypeError(
        f"{text!r} is not a number or a fraction such as 5/6"
    )
