"""The commands: each takes its options, and prints or writes what was asked for."""

import json
import logging
import shlex
from argparse import Namespace
from collections.abc import Mapping, Sequence
from dataclasses import replace
from importlib.metadata import version as installed_version
from pathlib import Path
from typing import Any

import numpy as np

from precursors.cli import Refused
from precursors.cli.files import (
    check_choices,
    given,
    how_to_read,
    measured_data,
    several,
    tell,
)
from precursors.cli.options import DATA, MEASURED, RUN, SLIDER_OPTIONS
from precursors.model.chain import (
    CELL_SPACING,
    SLIDER,
    Chain,
    theta_from_load_cells,
)
from precursors.solver.run import Record, Run, RunFileError
from precursors.solver.run_file import has_checksum
from precursors.support.checkout import built_state, git_state
from precursors.support.files import write_table
from precursors.support.measured import read_profile, read_weights

FOUND = "{counted} counted in Fig. 13, of {events_to_global_slip} "
FIRST_SLIP = """\
up to the first global slip and {events_in_all} in {duration_s:g} s.
mu_sapp = {mu_sapp:.3f} = {largest_load_N:.1f} N / {F_Z:g} N; first global slip at {global_slip_s:.3f} s.
"""
# Of `summarise`, what `simulate` tells.
SHOWN = (
    "transitions",
    "events_to_global_slip",
    "events_counted",
    "events_in_all",
    "mu_sapp",
    "largest_load_N",
    "global_slip_load_N",
    "global_slip_s",
    "global_slip_end_s",
)
# Columns of a slip table that follow from others in it, and make it wide to read.
TOLD_TWICE = ("largest_load_N", "front_length_m")
NO_SLIP = "in {duration_s:g} s; no global slip.\n"
SCORE = "{problem}: {transitions_right} of {transitions_true} transitions right"
ERRORS = (
    ", times within {time_error_s:.1e} s ({time_error_to_global_slip_s:.1e} s to the "
    "first global slip)"
)
COUNTED = (
    "; events counted {events_counted} (true: {events_counted_true}), "
    "mu_sapp {mu_sapp:.4f} (true: {mu_sapp_true:.4f})"
)
ENDS_EARLY = (
    "; it ends at {ends_s:g} s, before the first global slip (true: {events_counted_true} "
    "events counted, mu_sapp {mu_sapp_true:.4f})"
)
# A run with more transitions up to the first global slip takes seconds to repeat.
MOST_REPEATED = 50_000


def simulate(arguments: Namespace) -> None:
    """Run a chain, and print a sentence and a summary."""
    from precursors.analysis.summary import summarise

    run = run_of_options(arguments)
    [found] = summarise([run]).to_dict("records")
    values: dict[str, Any] = {
        "n_blocks": run.chain.n_blocks,
        "duration_s": run.duration,
        **{name: found[name] for name in SHOWN},
    }
    advice = "--output RUN.h5 saves the run; precursors plot RUN.h5 draws it"
    if arguments.output is not None:
        run.save(arguments.output)
        values["output"] = str(arguments.output)
        advice = f"precursors plot {shlex.quote(values['output'])} draws it"
    if not arguments.json:
        text = FOUND + (FIRST_SLIP if found["reached"] else NO_SLIP)
        counted = several(found["events_counted"], "event")
        print(text.format(**values, F_Z=run.chain.normal_load, counted=counted))
    show_values(values, arguments.json)
    if not arguments.json:
        print(f"\n{advice}")
    tell_accuracy(run, found["global_slip_s"])


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
        found = table.astype(object).where(table.notna(), None)
        print(json.dumps(found.to_dict(orient="records"), indent=1))
    elif arguments.output is not None:
        print(f"{several(len(table), 'event')}: {arguments.output}")
    elif table.empty:
        print("no slip event")
    else:
        shown = table.drop(columns=[*OF_SLIDER, *TOLD_TWICE])
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
        how["data"] = measured_data(arguments, run)
    drawn: Any = plot(run, look=look, **how)
    if arguments.data is not None:
        for line in drawn.get_label().splitlines():
            tell(line)
    if isinstance(drawn, Movie):
        drawn.savefig(arguments.output)
    else:
        save(drawn, arguments.output, look)
    show_values({"output": str(arguments.output.resolve())}, arguments.json)


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
        errors = ERRORS if values["transitions_right"] else ""
        numbers = ENDS_EARLY if np.isnan(values["mu_sapp"]) else COUNTED
        print((SCORE + errors + numbers).format(**values), end="\n\n")
    show_values(values, arguments.json)


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


def tell_accuracy(run: Record, first_global_slip: float) -> None:
    """Say if a light block decides what events are, or if roundings decide the first
    global slip [s]."""
    from precursors.analysis.events import told_of_light_blocks
    from precursors.analysis.horizon import predicted_errors

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
