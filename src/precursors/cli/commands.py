"""The commands: each takes its options, and prints or writes what was asked for."""

from __future__ import annotations

import json
import logging
import shlex
import sys
from argparse import Namespace
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from importlib.metadata import version as installed_version
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from precursors.cli import Refused
from precursors.cli.options import DATA, MEASURED, RUN, SLIDER_OPTIONS
from precursors.model.chain import (
    CELL_SPACING,
    SLIDER,
    Chain,
    FloatArray,
    theta_from_load_cells,
)
from precursors.solver.run import Record, Run, RunFileError
from precursors.solver.run_file import has_checksum
from precursors.support.checkout import built_state, git_state
from precursors.support.files import write_table
from precursors.support.measured import (
    LENGTH,
    LOAD,
    TIME,
    Quantity,
    read_profile,
    read_weights,
)

if TYPE_CHECKING:
    from precursors.figures.style import Measured

# What columns are chosen for, in files of each option.
KEYS = {"data": ("t", "F_X", "L_p/L"), "weights": ("w",), "profile": ("x", "p")}
# Of measured times in a run, of measured loads and its own.
LEAST_OVERLAP = 0.1
# A run with more transitions up to the first global slip takes seconds to repeat.
MOST_REPEATED = 50_000


def simulate(arguments: Namespace) -> None:
    """Run a chain, and print a sentence and a summary."""
    from precursors.analysis.summary import summarise

    run = run_of_options(arguments)
    records: Any = summarise([run]).to_dict("records")
    numbers = records[0]
    values = {"n_blocks": run.chain.n_blocks, "duration_s": run.duration, **numbers}
    del values["reached"]
    advice = "--output RUN.h5 saves the run; precursors plot RUN.h5 draws it"
    if arguments.output is not None:
        run.save(arguments.output)
        values["output"] = str(arguments.output)
        advice = f"precursors plot {shlex.quote(values['output'])} draws it"
    if not arguments.json:
        print(run_in_words(run, numbers), end="\n\n")
    show_values(values, arguments.json)
    if not arguments.json:
        print(f"\n{advice}")
    tell_accuracy(run, numbers["global_slip_s"])


def run_in_words(run: Run, numbers: Mapping[Any, Any]) -> str:
    """A sentence about a run, from its row of `summarise`."""
    counted = several(numbers["events_counted"], "event")
    text = f"{counted} counted in Fig. 13, of {numbers['events_to_global_slip']} "
    if not numbers["reached"]:
        return f"{text}in {run.duration:g} s; no global slip."
    return (
        f"{text}up to the first global slip and {numbers['events_in_all']} in "
        f"{run.duration:g} s.\n"
        f"mu_sapp = {numbers['mu_sapp']:.3f} = {numbers['largest_load_N']:.1f} N / "
        f"{run.chain.normal_load:g} N; first global slip at "
        f"{numbers['global_slip_s']:.3f} s."
    )


def slips(arguments: Namespace) -> None:
    """List the slip events of a run file, or of a chain that is run."""
    from precursors.analysis.slips import OF_SLIDER, slip_table

    run = run_of(arguments)
    table = slip_table(run)
    first_global_slip = table.loc[table["is_global"], "onset_s"].min()
    if arguments.counted:
        table = table[table["counted"]]
    if arguments.output is not None:
        write_table(table, arguments.output, arguments.decimal)
    if arguments.json:
        rows = table.astype(object).where(table.notna(), None)
        print(json.dumps(rows.to_dict(orient="records"), indent=1))
    elif arguments.output is not None:
        print(f"{several(len(table), 'event')}: {arguments.output}")
    elif table.empty:
        print("no slip event")
    else:
        # What follows from other columns makes the table wide to read.
        shown = table.drop(columns=[*OF_SLIDER, "largest_load_N", "front_length_m"])
        print(shown.to_string(index=False, na_rep="-", float_format="{:.7g}".format))
    tell_accuracy(run, first_global_slip)


def plot(arguments: Namespace) -> None:
    """Draw a run: its load and slips over time, its front lengths against the load,
    the push in its springs, or a wave."""
    from precursors.figures.run import Movie, plot
    from precursors.figures.style import Look, save

    logging.getLogger("matplotlib").setLevel(logging.ERROR)  # it tells of fonts
    look = Look(**given(arguments, ("width_mm", "font_size", "font")))
    how = given(arguments, ("figure", "title", "events"))
    unused = given(arguments, DATA)
    if unused and arguments.data is None:
        raise ValueError(f"--data is needed with {', '.join(unused)}")
    run = run_of(arguments)
    if arguments.data is not None:
        how["data"] = _measured(arguments, run)
    drawn: Any = plot(run, look=look, **how)
    if arguments.data is not None:
        for line in drawn.get_label().splitlines():
            tell(line)
    if isinstance(drawn, Movie):
        drawn.savefig(arguments.output)
    else:
        save(drawn, arguments.output, look)
    show_values({"output": str(arguments.output.resolve())}, arguments.json)


def _measured(arguments: Namespace, run: Record) -> list[Measured]:
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


def audit(arguments: Namespace) -> None:
    """Check that each run file is whole and its run a motion of the model."""
    from precursors.audit import audit

    wrong: list[str] = []
    for path in arguments.files:
        try:
            run = Run.load(path)
        except RunFileError as refused:
            wrong.append(str(refused))
            continue
        report = audit(run)
        if report.ok:
            print(
                f"{path}: a motion of the model, "
                f"{several(len(run.transitions), 'transition')} in {run.duration:g} s"
            )
            if not has_checksum(path):
                tell(
                    f"{path} has no checksum, as it is older: the length of its contact is not checked"
                )
        else:
            is_not = "undecided" if report.is_undecided else "not a motion of the model"
            wrong.append(f"{path}: {is_not}: {report.problems[0]}")
    if wrong:
        raise Refused(*wrong)


def score(arguments: Namespace) -> None:
    """Score a result file on a proved problem."""
    from precursors.benchmark.score import score

    values = score(arguments.file, arguments.problem, arguments.ties)
    if not arguments.json:
        print(score_in_words(values), end="\n\n")
    show_values(values, arguments.json)


def score_in_words(values: Mapping[str, Any]) -> str:
    """A sentence about a score."""
    text = (
        f"{values['problem']}: {values['transitions_right']} of "
        f"{values['transitions_true']} transitions right"
    )
    if values["transitions_right"]:
        text += (
            f", times within {values['time_error_s']:.1e} s "
            f"({values['time_error_to_global_slip_s']:.1e} s to the first global slip)"
        )
    true_counted = values["events_counted_true"]
    true_friction = values["mu_sapp_true"]
    if np.isnan(values["mu_sapp"]):
        return (
            f"{text}; it ends at {values['ends_s']:g} s, before the first global slip "
            f"(true: {true_counted} events counted, mu_sapp {true_friction:.4f})"
        )
    return (
        f"{text}; events counted {values['events_counted']} (true: {true_counted}), "
        f"mu_sapp {values['mu_sapp']:.4f} (true: {true_friction:.4f})"
    )


def version(_: Namespace) -> None:
    """Print the version, and the commit of the checkout or wheel and its software hash
    identifiers."""
    print(f"precursors {installed_version('precursors')}")
    state = git_state(Path(__file__).parents[3]) or built_state()
    if not state:
        print("commit unknown: it was built without git")
        return
    print(
        f"commit {state['commit']}{', and files have changed since' if state['changed'] else ''}"
    )
    print(state["swh_revision"], state["swh_directory"], sep="\n")


def run_of(arguments: Namespace) -> Record:
    """Read the run file, or run the chain of the options."""
    if arguments.file is None:
        return run_of_options(arguments)
    check_choices(arguments)
    if given(arguments, (*MEASURED, *SLIDER_OPTIONS, *RUN)):
        raise ValueError(
            f"{arguments.file}: a run file cannot be combined with options of a chain"
        )
    try:
        return Record.load(arguments.file)
    except RunFileError as error:
        raise Refused(str(error)) from error


def run_of_options(arguments: Namespace) -> Run:
    """Run the chain of the options."""
    from numba.core import event

    from precursors.solver.simulate import TransitionLimitError, simulate
    from precursors.support.compiled import Announcement

    check_choices(arguments)
    event.register("numba:compile", Announcement())  # the first run takes long
    slider = given(arguments, SLIDER_OPTIONS)
    measured = given(arguments, MEASURED)
    chain = _chain(arguments, slider, **measured)
    if measured:
        source = next(iter(measured.values()))
        loads = chain.weights
        tell(
            f"{source}: {several(chain.n_blocks, 'block')}, {loads.min():g} to {loads.max():g} N, "
            f"F_Z = {chain.normal_load:g} N"
        )
    try:
        return simulate(chain, **given(arguments, RUN))
    except TransitionLimitError as error:
        if arguments.command != "simulate" or arguments.output is None:
            raise Refused(str(error)) from error
        error.run.save(arguments.output)
        raise Refused(f"{error}; the run so far is in {arguments.output}") from error


def _chain(
    arguments: Namespace,
    slider: dict[str, Any],
    weights: str | None = None,
    profile: str | None = None,
    load_cells: Sequence[float] | None = None,
    cell_spacing: float | None = None,
) -> Chain:
    """The chain of a slider, whose loads may be measured."""
    if load_cells is not None:
        a, b = load_cells
        length = slider.get("length", SLIDER["length"])
        spacing = CELL_SPACING if cell_spacing is None else cell_spacing
        theta = theta_from_load_cells(a, b, spacing, length)
        slider = {"normal_load": a + b} | slider | {"theta": float(theta)}
    elif cell_spacing is not None:
        raise ValueError("--cell-spacing needs --load-cells")
    if weights is not None:
        how = how_to_read(arguments, "weights")
        return Chain.from_slider(weights=read_weights(weights, **how), **slider)
    if profile is not None:
        *xs, shape = read_profile(profile, **how_to_read(arguments, "profile"))
        return Chain.from_profile(shape, positions=xs[0] if xs else None, **slider)
    return Chain.from_slider(**slider)


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
    found = {name: getattr(arguments, name) for name in names}
    return {name: value for name, value in found.items() if value is not None}


def several(number: int, noun: str) -> str:
    """A number of things, in words."""
    return f"{number} {noun}{'' if number == 1 else 's'}"


def tell(line: str) -> None:
    """Say something beside the result."""
    print(line, file=sys.stderr)


def tell_accuracy(run: Record, first_global_slip: float) -> None:
    """Say if a light block decides what events are, or if roundings decide the first
    global slip [s]."""
    from precursors.analysis.horizon import predicted_errors
    from precursors.analysis.slips import told_of_light_blocks

    if words := told_of_light_blocks(run):
        tell(words)
    until = run.transitions[run.transitions["time"] <= first_global_slip]
    if not isinstance(run, Run) or not 0 < len(until) <= MOST_REPEATED:
        return
    up_to_slip = replace(run, duration=first_global_slip, transitions=until)
    known = predicted_errors(up_to_slip).order_known_until
    if known < first_global_slip:
        tell(
            f"the first global slip at {first_global_slip:.3f} s is beyond predictability: roundings "
            f"decide from {known:.3f} s on"
        )


def show_values(values: Mapping[str, Any], as_json: bool) -> None:
    """Print named values, one a line, ten digits a number; JSON has null for NaN."""
    values = {name: None if x != x else x for name, x in values.items()}  # NaN
    if as_json:
        print(json.dumps(values, indent=1))
        return
    width = max(map(len, values))
    for name, value in values.items():
        text = f"{value:.10g}" if isinstance(value, float) else value
        print(f"{name:<{width}}  {'-' if text is None else text}")
