"""Options that several commands share: the chain, how long it runs, and the run or run file to work on."""

from __future__ import annotations

import argparse
import re
from collections.abc import Sequence
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Any

from precursors.cli.exit_codes import Refused
from precursors.support.progress import Progress

if TYPE_CHECKING:
    from precursors.model.chain import Until
    from precursors.solver.run import Run

# Option, argument of `Chain.from_slider`, its default there, and what it is.
CHAIN_NUMBERS = (
    ("--normal-load", "normal_load", "400", "total normal load F_Z [N]"),
    ("--mu-s", "mu_s", "0.70", "coefficient of static friction"),
    ("--mu-k", "mu_k", "0.45", "coefficient of kinetic friction"),
    ("--drive-stiffness", "drive_stiffness", "0.8e6", "stiffness K of the drive's spring [N/m]"),
    ("--drive-velocity", "drive_velocity", "1e-4", "speed V of the drive [m/s]"),
    ("--slider-mass", "slider_mass", "0.012", "mass M of the slider [kg]"),
    ("--youngs-modulus", "youngs_modulus", "2.5e9", "Young's modulus E [Pa]"),
    ("--cross-section", "cross_section", "1e-4", "cross section S [m^2]"),
    ("--length", "length", "0.1", "length L of the contact [m]"),
    ("--viscosity", "viscosity", "0", "dashpot between neighbours [N s/m]"),
    ("--interface-stiffness", "interface_stiffness", "0", "stiffness of the whole interface [N/m], 0: rigid"),
    ("--head-mass", "head_mass", "0", "mass of a loading head on block 1 [kg]"),
)
DURATION = 10.0


def number(text: str) -> float:
    """Read a number, or a fraction such as 5/6."""
    try:
        return float(Fraction(text)) if "/" in text else float(text)
    except (ValueError, ZeroDivisionError, OverflowError):
        raise argparse.ArgumentTypeError(f"{text!r} is not a number or a fraction such as 5/6") from None


def whole(text: str) -> int:
    """Read a whole number."""
    try:
        return int(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r} is not a whole number") from None


def join_negative_values(argv: Sequence[str]) -> list[str]:
    """Write `--theta -5/6` as `--theta=-5/6`, since argparse takes -5/6 for an option."""
    joined: list[str] = []
    for argument in argv:
        if joined and re.fullmatch(r"-[\d.][\d./eE+-]*", argument) and re.fullmatch(r"--[^=]+", joined[-1]):
            joined[-1] += f"={argument}"
        else:
            joined.append(argument)
    return joined


def add_chain(parser: argparse.ArgumentParser) -> None:
    """Add the options that make a chain; those that are not given stay None."""
    group = parser.add_argument_group("the chain", "what is not given is the paper's")
    group.add_argument(
        "--theta", metavar="X", help='non-uniformity of the normal loading, -1 to 1, "5/6" is read (0)'
    )
    group.add_argument("--blocks", dest="n_blocks", type=whole, metavar="N", help="number of blocks (10)")
    for option, name, default, meaning in CHAIN_NUMBERS:
        group.add_argument(option, dest=name, type=number, metavar="X", help=f"{meaning} ({default})")


def add_duration(parser: argparse.ArgumentParser) -> None:
    """Add the options that say how long a chain runs."""
    group = parser.add_argument_group("the run")
    group.add_argument("--duration", type=number, metavar="S", help=f"time to run [s] ({DURATION:g})")
    group.add_argument(
        "--until-global-slip",
        action="store_true",
        help="stop at the end of the first global slip; the duration is the limit",
    )
    group.add_argument("--max-transitions", type=whole, metavar="N", help="cap on transitions (10 million)")


def add_run(parser: argparse.ArgumentParser) -> None:
    """Add a run file, or instead of it the options that make a chain and run it."""
    parser.add_argument(
        "file", nargs="?", type=Path, metavar="RUN.h5", help="a run file; else a chain is run"
    )
    add_chain(parser)
    add_duration(parser)


def slider_of(arguments: argparse.Namespace) -> dict[str, Any]:
    """Arguments of `Chain.from_slider` that were given."""
    names = ("theta", "n_blocks", *(name for _, name, _, _ in CHAIN_NUMBERS))
    return {name: getattr(arguments, name) for name in names if getattr(arguments, name) is not None}


def simulate_of(arguments: argparse.Namespace) -> Run:
    """Run the chain that the options stand for.

    Raises
    ------
    Refused
        If the run met its cap on transitions.
    ValueError
        If a value is out of range.
    """
    from precursors.model.chain import Chain

    chain = Chain.from_slider(**slider_of(arguments))
    with Progress("simulating"):
        from precursors.solver.simulate import TransitionLimitError, simulate

        limit = {} if arguments.max_transitions is None else {"max_transitions": arguments.max_transitions}
        try:
            return simulate(chain, duration_of(arguments), until_of(arguments), **limit)
        except TransitionLimitError as error:
            raise Refused(str(error)) from error


def run_of(arguments: argparse.Namespace) -> Run:
    """Read the run file that was given, or run the chain that the options stand for.

    Raises
    ------
    Refused
        If the file is not a whole run, or a run met its cap on transitions.
    OSError
        If the file cannot be read.
    ValueError
        If there are both a file and options of a chain, or a value is out of range.
    """
    if arguments.file is None:
        return simulate_of(arguments)
    run_options = {"duration", "until_global_slip", "max_transitions"}
    if slider_of(arguments) or any(getattr(arguments, name) for name in run_options):
        raise ValueError(f"{arguments.file} and options of a chain: allowed is one or the other")
    with Progress("reading"):
        return load(arguments.file)


def load(path: Path) -> Run:
    """Read a run file; raise Refused if it is not a whole run."""
    from precursors.solver.run import Run, RunFileError

    try:
        return Run.load(path)
    except RunFileError as error:
        raise Refused(str(error)) from error


def duration_of(arguments: argparse.Namespace) -> float:
    """Time to run [s]."""
    return DURATION if arguments.duration is None else arguments.duration


def until_of(arguments: argparse.Namespace) -> Until:
    """Where to stop before the duration is over."""
    return "global slip" if arguments.until_global_slip else None
