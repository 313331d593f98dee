"""The commands: each takes its options and prints or writes its result."""

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
    note,
    several,
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

# Predicting the errors of a run with more transitions would take seconds.
MOST_REPEATED = 50_000


def simulate(arguments: Namespace) -> None:
    """Run a chain and print a summary, first in words and then in numbers."""
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
    warn_of_limits(run, numbers["global_slip_s"])


def run_in_words(run: Run, numbers: Mapping[Any, Any]) -> str:
    """Describe a run in words, from its row of `summarise`."""
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
    """List the slip events of a run file, or of a chain given by options."""
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
        # These columns follow from the others and would make the table too wide.
        shown = table.drop(columns=[*OF_SLIDER, "largest_load_N", "front_length_m"])
        print(shown.to_string(index=False, na_rep="-", float_format="{:.7g}".format))
    warn_of_limits(run, first_global_slip)


def plot(arguments: Namespace) -> None:
    """Draw the figure of a run that the options choose."""
    from precursors.figures.run import Movie, plot
    from precursors.figures.style import Look, save

    logging.getLogger("matplotlib").setLevel(logging.ERROR)  # no notes about fonts
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
            note(line)
    if isinstance(drawn, Movie):
        drawn.savefig(arguments.output)
    else:
        save(drawn, arguments.output, look)
    show_values({"output": str(arguments.output.resolve())}, arguments.json)


def audit(arguments: Namespace) -> None:
    """Check that each run file is intact and its run is a motion of the model."""
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
                note(
                    f"{path} is an older file without a checksum: the length of its contact is not checked"
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
    """Describe a score in words."""
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
    """Read the run file, or run the chain given by the options."""
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
    """Run the chain given by the options."""
    from numba.core import event

    from precursors.solver.simulate import TransitionLimitError, simulate
    from precursors.support.compiled import Announcement

    check_choices(arguments)
    event.register("numba:compile", Announcement())  # compiling delays the first run
    slider = given(arguments, SLIDER_OPTIONS)
    measured = given(arguments, MEASURED)
    chain = _chain(arguments, slider, **measured)
    if measured:
        source = next(iter(measured.values()))
        loads = chain.weights
        note(
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
    """Make the chain of a slider, with measured normal loads if they are given."""
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


def warn_of_limits(run: Record, first_global_slip: float) -> None:
    """Warn if a light block changes the slip events, or if rounding decides the first
    global slip [s]."""
    from precursors.analysis.horizon import predicted_errors
    from precursors.analysis.slips import describe_light_blocks

    if words := describe_light_blocks(run):
        note(words)
    until = run.transitions[run.transitions["time"] <= first_global_slip]
    if not isinstance(run, Run) or not 0 < len(until) <= MOST_REPEATED:
        return
    up_to_slip = replace(run, duration=first_global_slip, transitions=until)
    known = predicted_errors(up_to_slip).order_known_until
    if known < first_global_slip:
        note(
            f"the first global slip at {first_global_slip:.3f} s is beyond predictability: "
            f"it depends on rounding from {known:.3f} s on"
        )


def show_values(values: Mapping[str, Any], as_json: bool) -> None:
    """Print one named value per line with ten digits, or JSON, where NaN is null."""
    values = {name: None if x != x else x for name, x in values.items()}  # NaN
    if as_json:
        print(json.dumps(values, indent=1))
        return
    width = max(map(len, values))
    for name, value in values.items():
        text = f"{value:.10g}" if isinstance(value, float) else value
        print(f"{name:<{width}}  {'-' if text is None else text}")
