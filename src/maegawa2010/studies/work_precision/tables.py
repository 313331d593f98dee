"""Speed against accuracy: methods with several settings, timed side by side and
compared with the truth."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from itertools import product
from typing import TYPE_CHECKING, Any

import pandas as pd

from maegawa2010.methods import METHODS, ROWS, Method, Result, attempt
from maegawa2010.paper.committed import compared
from maegawa2010.support import timing
from precursors.analysis.horizon import predicted_errors
from precursors.benchmark.compare import Truth, compare
from precursors.benchmark.score import solution
from precursors.model.chain import Chain
from precursors.model.checks import Until
from precursors.solver.run import Record
from precursors.solver.simulate import simulate

if TYPE_CHECKING:
    from precursors.proof import Certificate

UNTIL = "global slip"
# A time is the median of so many rounds. A call that takes longer than `LONG` [s] is
# timed once, because it averages over the machine's other load by itself.
ROUNDS = 5
LONG = 0.05
LONGEST = 5.0  # s; a setting with a longer call is left out, and so are tighter ones
# Duration [s] of a run before the timing, in which a method compiles, loads and builds
# what it needs for a chain and a value.
WARM_UP = 0.4
SHORTEST = 0.0025  # s, see `timing.measure`
# beside_heyoka.csv has the runs of these proved chains (by theta) to each of these ends.
PROBLEMS = {"0": "uniform", "-5/6": "trailing", "5/6": "leading"}
ENDS: dict[str, Until] = {"to the first global slip": "global slip", "10 s": None}
DURATION = 10.0  # s, the limit where a run ends by itself
# Tolerances of a run on another machine: its number of evaluations and its error differ
# by a few per cent, and its error also by rounding.
RELATIVE = 0.05
ROUNDING_S = 1e-12
ROUNDING_N = 1e-12


def work_precision_table(
    certificate: Certificate, scene: str, full: bool
) -> pd.DataFrame:
    """Measure all methods on a proved chain, up to its first global slip."""
    truth = Truth.proved(certificate).until_global_slip()
    duration = float(certificate.proved_until)
    table = measure_methods(truth, duration, charted_values(full))
    table.insert(0, "scene", scene)
    return table


def charted_values(full: bool) -> dict[str, tuple[float, ...]]:
    """Values of each method's setting in the default chart or the full one, from loose
    to tight."""
    column = "values" if full else "quick"
    return {name: tuple(map(float, row[column].split())) for name, row in ROWS.items()}


def measure_methods(
    truth: Truth,
    duration: float,
    values: Mapping[str, Sequence[float]],
    rounds: int = ROUNDS,
    longest: float = LONGEST,
    long: float = LONG,
) -> pd.DataFrame:
    """Time methods with several settings, and compare each run with the truth.

    A run ends with the first global slip, as the truth does, or after `duration` [s]. A
    run that breaks off counts as far as it got. `values` of each method's setting go from
    loose to tight. A time is the median of some rounds in which methods take turns, after
    a short warm-up; a call that takes longer than `long` [s] is timed once. A setting with
    a call longer than `longest` [s] is left out, and so are the method's tighter settings.

    Returns
    -------
    DataFrame
        A row per method and value; `evaluations` is NaN for a method that counts none,
        and errors are those of `Comparison`.
    """
    tasks: dict[int, Callable[[], Result]] = {}
    rows: list[dict[str, object]] = []
    chain = truth.run.chain
    for name, some in values.items():
        for value in some:
            task, warm_up = (
                partial(attempt, METHODS[name].solve, chain, end, value, UNTIL)
                for end in (duration, min(WARM_UP, duration))
            )
            warm_up()
            result, seconds = timing.timed(task)
            if seconds.wall > longest:
                break
            if seconds.wall <= long:
                tasks[len(rows)] = task
            rows.append(_row(truth, METHODS[name], value, result, seconds.wall))
    for key, timed in timing.measure(tasks, rounds, SHORTEST).items():
        rows[key]["seconds"] = timed.seconds
    return pd.DataFrame(rows)


def _row(
    truth: Truth, method: Method, value: float, result: Result, seconds: float
) -> dict[str, object]:
    agreement = compare(result.run, truth)
    return {
        "method": method.name,
        "label": ROWS[method.name]["label"],
        "color": ROWS[method.name]["color"],
        "marker": ROWS[method.name]["marker"],
        "setting": method.setting,
        "value": value,
        "evaluations": result.evaluations or math.nan,
        "seconds": seconds,
        "time_error_s": agreement.time_error,
        "transitions_right": agreement.transitions_right,
        "transitions_found": agreement.transitions_found,
        "transitions_true": agreement.transitions_true,
    }


def errors_of(name: str, run: Record, truth: Truth) -> Iterator[tuple[str, str, float]]:
    """Yield quantity, unit and value of beside_heyoka.csv for a run of a solver: its right
    transitions and its largest errors."""
    agreement = compare(run, truth)
    right = f"transitions of {name} right, of {agreement.transitions_true}"
    yield right, "1", agreement.transitions_right
    yield f"largest error of their times, {name}", "s", agreement.time_error
    yield f"largest error of F_X at slip onsets, {name}", "N", agreement.load_error


def truth_of(theta: str, end: str) -> Truth:
    """The proved transitions of the paper's slider up to an end (a key of `ENDS`)."""
    truth = solution(PROBLEMS[theta])
    return truth if ENDS[end] is None else truth.until_global_slip()


def with_rightness(table: pd.DataFrame) -> pd.DataFrame:
    """Add the column is_right: whether a run has all true transitions, and no other."""
    true = table["transitions_true"]
    right, all_of = table["transitions_right"], table["transitions_found"]
    return table.assign(is_right=right.eq(true) & all_of.eq(true))


def check(tables: Mapping[str, pd.DataFrame], measured: pd.DataFrame) -> pd.DataFrame:
    """Compare the committed tables with `measured`, the table of this build, and with runs
    of the exact solver.

    `tables` are the committed tables by name. Computing times are not compared.
    """
    speed, row = tables["speed"], ["method", "value"]
    known = with_rightness(speed[row].merge(measured, on=row))
    right = known[known["is_right"]]
    close = {
        "evaluations": RELATIVE * right["evaluations"],
        "time_error_s": RELATIVE * right["time_error_s"] + ROUNDING_S,
    }
    speed = with_rightness(speed)
    comparisons = [
        compared("speed", speed, known, row, {"is_right": 0.0}),
        compared("speed", speed, right, row, close),
    ]
    beside, row = tables["beside_heyoka"], ["measurement", "case", "quantity"]
    exact: list[dict[str, Any]] = []
    for theta, (end, until) in product(PROBLEMS, ENDS.items()):
        chain = Chain.from_slider(theta=theta)
        run = simulate(chain, DURATION, until)
        error = predicted_errors(run).time_error.max()
        of_unit = {"1": 0.0, "s": error, "N": chain.loading_rate * error + ROUNDING_N}
        label = {"measurement": "heyoka", "case": f"theta = {theta}, {end}"}
        for quantity, unit, value in errors_of("exact", run, truth_of(theta, end)):
            tolerance = {"tolerance": of_unit[unit]}
            exact.append(label | {"quantity": quantity, "value": value} | tolerance)
    tolerances = {"value": [one["tolerance"] for one in exact]}
    comparisons.append(compared("beside_heyoka", beside, exact, row, tolerances))
    return pd.concat(comparisons, ignore_index=True)
