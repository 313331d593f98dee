"""Measured files of the command line: how each is read, and what is said of it."""

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

# What columns are chosen for, in files of each option.
KEYS = {"data": ("t", "F_X", "L_p/L"), "weights": ("w",), "profile": ("x", "p")}
# Of measured times in a run, of measured loads and its own.
LEAST_OVERLAP = 0.1


def measured_data(arguments: Namespace, run: Record) -> list[Measured]:
    """What is measured in each file; lines say what it is, and if it may be something
    else."""
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
            tell(f"{path}: {several(len(each.points), 'point')}, {', '.join(ranges)}")
            tell_doubts(path, columns, run)
            is_alone = names.count(each.name) == 1
            measured.append(each if is_alone else replace(each, name=path))
    return measured


def tell_doubts(path: str, data: Mapping[Quantity, FloatArray], run: Record) -> None:
    """Say if measured values hardly overlap a run, as in other units, or if all loads
    are below zero."""
    from precursors.analysis.slips import slip_table

    times = data.get(TIME, np.zeros(1))
    inside = ((times >= 0) & (times <= run.duration)).sum()
    apart = []
    if inside < LEAST_OVERLAP * len(times):
        apart.append(f"{inside} of its {len(times)} times are among those of the run")
    if LOAD in data:
        reach = np.abs(data[LOAD]).max() / slip_table(run)["largest_load_N"].max()
        if reach <= LEAST_OVERLAP or reach >= 1 / LEAST_OVERLAP:
            apart.append(f"it reaches {reach:.2g} times as high as F_X of the run")
    if apart:
        tell(
            f"{path} hardly overlaps the run: {', and '.join(apart)} (--data-start says "
            "when the run begins, --columns the units)"
        )
    if LOAD in data and data[LOAD].max() < 0:
        tell(f"{path}: all of F_X is below zero: is its sign turned?")


def check_choices(arguments: Namespace) -> None:
    """Refuse a choice of columns or a line of names of a file that is not given."""
    files = [option for option in KEYS if getattr(arguments, option, None) is not None]
    for choice in arguments.columns or []:
        for option, keys in KEYS.items():
            for key in choice.keys() & {*keys} if option not in files else ():
                raise ValueError(f"--columns {key}=... needs --{option}")
    if arguments.header_line and not files:
        raise ValueError("--header-line needs --data, --weights or --profile")


def how_to_read(arguments: Namespace, option: str, place: int = 0) -> dict[str, Any]:
    """Choice of columns and line of names for a file of an option, the files being
    normal loads first, then the data in their order."""
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
    """The value of an option for one of some files, which is given once for all of them
    or once for each."""
    if values and len(values) not in (1, number):
        raise ValueError(
            f"--{option.replace('_', '-')} must be given once, or once for each of "
            f"{several(number, 'file')}, but is given {len(values)} times"
        )
    return values and values[place if len(values) > 1 else 0]


def given(arguments: Namespace, names: Iterable[str]) -> dict[str, Any]:
    """Options that were given, of those named."""
    values = {name: getattr(arguments, name) for name in names}
    return {name: value for name, value in values.items() if value is not None}


def several(number: int, noun: str) -> str:
    """A number of things, in words."""
    return f"{number} {noun}{'' if number == 1 else 's'}"


def tell(line: str) -> None:
    """Say something beside the result."""
    print(line, file=sys.stderr)
