"""Measured files on the command line: how to read them, and notes about them."""

from __future__ import annotations

import sys
from argparse import Namespace
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from precursors.cli.options import DATA
from precursors.model.chain import FloatArray
from precursors.solver.run import Record
from precursors.support.measured import LENGTH, LOAD, TIME, Quantity

if TYPE_CHECKING:
    from precursors.figures.style import Measured

# Symbols for which --columns may choose a column, by the option of the file.
KEYS = {"data": ("t", "F_X", "L_p/L"), "weights": ("w",), "profile": ("x", "p")}
# Smallest share of measured times within a run, and smallest ratio of measured and
# simulated loads, that raise no doubt.
LEAST_OVERLAP = 0.1


def measured_data(arguments: Namespace, run: Record) -> list[Measured]:
    """Read the measured files, and print a note on what each contains."""
    from precursors.figures.run import axes_of, read_measured

    x, *_ = axes_of(arguments.figure)
    if x is not TIME and given(arguments, ("sample_rate", "data_start")):
        raise ValueError("--sample-rate and --data-start need --figure load or curve")
    measured = []
    names = [Path(path).name for path in arguments.data]
    for i, path in enumerate(arguments.data):
        how = {
            name: of_file(name, getattr(arguments, name), i, len(names))
            for name in DATA
        }
        how |= how_to_read(arguments, "data", i)
        for each in read_measured(path, arguments.figure, run, **how):
            y = LENGTH if each.are_lengths else LOAD
            columns = dict(zip((x, y), each.points.T, strict=True))
            ranges = (f"{q} {x.min():g} to {x.max():g}" for q, x in columns.items())
            note(f"{path}: {several(len(each.points), 'point')}, {', '.join(ranges)}")
            warn_of_mismatch(path, columns, run)
            is_alone = names.count(each.name) == 1
            measured.append(each if is_alone else replace(each, name=path))
    return measured


def warn_of_mismatch(
    path: str, data: Mapping[Quantity, FloatArray], run: Record
) -> None:
    """Warn if measured values hardly overlap the run, as in wrong units, or if all loads
    are negative."""
    from precursors.analysis.slips import slip_table

    times = data.get(TIME, np.zeros(1))
    inside = ((times >= 0) & (times <= run.duration)).sum()
    apart = []
    if inside < LEAST_OVERLAP * len(times):
        apart.append(f"{inside} of its {len(times)} times are within the run")
    if LOAD in data:
        reach = np.abs(data[LOAD]).max() / slip_table(run)["largest_load_N"].max()
        if reach <= LEAST_OVERLAP or reach >= 1 / LEAST_OVERLAP:
            apart.append(f"it reaches {reach:.2g} times the largest F_X of the run")
    if apart:
        note(
            f"{path} hardly overlaps the run: {', and '.join(apart)} (--data-start says "
            "when the run begins, --columns the units)"
        )
    if LOAD in data and data[LOAD].max() < 0:
        note(f"{path}: all of F_X is negative: is its sign reversed?")


def check_choices(arguments: Namespace) -> None:
    """Refuse --columns and --header-line for a file that is not given."""
    files = [option for option in KEYS if getattr(arguments, option, None) is not None]
    for choice in arguments.columns or []:
        for option, keys in KEYS.items():
            for key in choice.keys() & {*keys} if option not in files else ():
                raise ValueError(f"--columns {key}=... needs --{option}")
    if arguments.header_line and not files:
        raise ValueError("--header-line needs --data, --weights or --profile")


def how_to_read(arguments: Namespace, option: str, place: int = 0) -> dict[str, Any]:
    """Return the chosen columns and the header line for one file of an option.

    `place` is its place among the files of the option. The file of normal loads comes
    before those of --data.
    """
    data = getattr(arguments, "data", None) or []
    loads = given(arguments, ("weights", "profile"))
    n = len(loads) + len(data)
    i = place + len(loads) if option == "data" else place
    choice = of_file("columns", arguments.columns, i, n) or {}
    return {
        "choice": {key: choice[key] for key in KEYS[option] if key in choice},
        "header_line": of_file("header_line", arguments.header_line, i, n),
    }


def of_file(option: str, values: Sequence[Any] | None, place: int, number: int) -> Any:
    """Return the value of an option for one file; the option is given once for all files
    or once for each."""
    if values and len(values) not in (1, number):
        raise ValueError(
            f"--{option.replace('_', '-')} must be given once, or once for each of "
            f"{several(number, 'file')}, but is given {len(values)} times"
        )
    return values and values[place if len(values) > 1 else 0]


def given(arguments: Namespace, names: Iterable[str]) -> dict[str, Any]:
    """Return those of the named options that the user has given."""
    values = {name: getattr(arguments, name) for name in names}
    return {name: value for name, value in values.items() if value is not None}


def several(number: int, noun: str) -> str:
    """Return a number with its noun, such as "2 blocks"."""
    return f"{number} {noun}{'' if number == 1 else 's'}"


def note(line: str) -> None:
    """Print a note for the user on standard error."""
    print(line, file=sys.stderr)
