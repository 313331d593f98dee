"""Compare the exact solver with heyoka.py and DOP853: computing times, and errors against
proofs.

    make bench                 everything, in a minute or two
    make bench METHOD=name     one method, in seconds

With --quick the sizes are reduced, to test that it runs.

Only ratios of times are meaningful: everything that is compared runs in turn in one
process on one thread (see `maegawa2010.support.timing`).
"""

from __future__ import annotations

import os

# Must be set before NumPy and Numba are imported.
os.environ |= dict.fromkeys(
    ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS"),
    "1",
)

# isort: split
import argparse
import sys
from collections.abc import Callable, Iterable
from contextlib import ExitStack, suppress
from functools import partial
from importlib.util import find_spec
from pathlib import Path
from statistics import median
from time import process_time
from typing import Any
from unittest.mock import patch

import pandas as pd

from maegawa2010.methods import METHODS, cvode_events, events
from maegawa2010.methods.common import Result
from maegawa2010.methods.heyoka_events import solve_heyoka
from maegawa2010.methods.scipy_events import solve_scipy
from maegawa2010.studies.work_precision.tables import (
    DURATION,
    ENDS,
    LONGEST,
    PROBLEMS,
    ROUNDS,
    charted_values,
    errors_of,
    measure_methods,
    truth_of,
)
from maegawa2010.support import timing
from precursors import Chain, Record, simulate, simulate_many
from precursors.benchmark.score import solution
from precursors.model.statics import maximal_strain_positions
from precursors.solver.simulate import TransitionLimitError
from precursors.support.compiled import untyped
from precursors.support.files import write_table

ROOT = Path(__file__).resolve().parent.parent
TABLE = ROOT / "results" / "tables" / "bench.csv"
HEYOKA_TOLERANCE = 0.0  # its default, machine precision
DOP853_TOLERANCE = 1e-13
ENSEMBLE, HEYOKA_ENSEMBLE = 2000, 100
# The chain starts strained and is driven fast, so that all of it slips without a pause.
LONG_CHAIN, SHORT_CHAIN, STRAIN, FAST_DRIVE = (
    200,
    10,
    0.9,
    0.02,
)  # blocks, blocks, of the maximal one, m/s
GROWTH_TRANSITIONS = 6000

SHOWN = [
    "method",
    "value",
    "seconds",
    "evaluations",
    "time_error_s",
    "transitions_right",
    "transitions_true",
]

Row = dict[str, Any]


def main() -> None:
    """Measure, and print and write the table."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument(
        "--quick", action="store_true", help="reduce the sizes, to test that it runs"
    )
    parser.add_argument(
        "--output", type=Path, default=TABLE, help="the CSV file (%(default)s)"
    )
    parser.add_argument(
        "--method", choices=METHODS, metavar="NAME", help="measure this method only"
    )
    parser.add_argument(
        "--sessions",
        type=int,
        default=1,
        help="number of repetitions; medians and ranges are written",
    )
    arguments = parser.parse_args()
    if arguments.method:
        table = one_method(arguments.method, rounds=1 if arguments.quick else ROUNDS)
        print(table[SHOWN].to_string(index=False))
        return
    measure = (
        partial(timing.measure, rounds=2, shortest=0.0)
        if arguments.quick
        else timing.measure
    )
    rows: list[Row] = []
    for _ in range(arguments.sessions):
        for measurement in (
            against_heyoka(measure),
            against_dop853(measure),
            ensemble(measure, arguments.quick),
            heyoka_ensemble(measure, arguments.quick),
            in_callbacks(),
            long_chains(measure),
        ):
            for row in measurement:
                print(
                    f"{row['measurement']:9} {row['case']:38} {row['quantity']:46} "
                    f"{row['value']:10.4g} {row['unit']}",
                    flush=True,
                )
                rows.append(row)
    sessions = pd.DataFrame(rows).groupby(
        ["measurement", "case", "quantity", "unit"], sort=False
    )["value"]
    medians = sessions.agg(
        value="median", least="min", largest="max", sessions="count"
    ).reset_index()
    write_table(medians, arguments.output)


def one_method(name: str, rounds: int) -> pd.DataFrame:
    """Measure a method, the exact solver and heyoka.py for theta = 0, up to the end of
    the first global slip."""
    truth = solution("uniform").until_global_slip()
    quick = charted_values(full=False)
    values = {
        other: settings[-1:]
        for other, settings in quick.items()
        if other in ("exact", "heyoka")
    }
    values[name] = quick[name] or charted_values(full=True)[name]
    table = measure_methods(truth, DURATION, values, rounds)
    left = sorted({*values[name]} - {*table.loc[table["method"] == name, "value"]})
    if left:
        print(
            f"{name}: given up at {METHODS[name].setting} = {left[-1]:g}, where a call "
            f"takes longer than {LONGEST:g} s",
            file=sys.stderr,
        )
    return table


def against_heyoka(measure: Callable[..., Any]) -> Iterable[Row]:
    """Compare with heyoka.py at its default tolerance, for the paper's three scenes."""
    if not find_spec("heyoka"):
        print("heyoka.py is not installed: left out", file=sys.stderr)
        return
    for theta in PROBLEMS:
        for name, until in ENDS.items():
            solve = partial(
                solve_heyoka,
                Chain.from_slider(theta=theta),
                DURATION,
                HEYOKA_TOLERANCE,
                until,
            )
            yield from compared("heyoka", theta, name, solve, measure)


def against_dop853(measure: Callable[..., Any]) -> Iterable[Row]:
    """Compare with SciPy's DOP853 at a tight tolerance, for theta = 0 up to the end of
    the first global slip."""
    solve = partial(
        solve_scipy, Chain.from_slider(), DURATION, DOP853_TOLERANCE, "global slip"
    )
    yield from compared("DOP853", "0", "to the first global slip", solve, measure)


def compared(
    other: str,
    theta: str,
    end: str,
    solve: Callable[[], Result],
    measure: Callable[..., Any],
) -> Iterable[Row]:
    """Ratio of another method's time to that of the exact solver, and both errors."""
    chain, until = Chain.from_slider(theta=theta), ENDS[end]
    tasks: dict[str, Callable[[], Record]] = {
        "exact": partial(simulate, chain, DURATION, until),
        other: lambda: solve().run,
    }
    truth = truth_of(theta, end)
    timings = measure(tasks)
    wall, cpu = timings["exact"].times_faster_than(timings[other])
    row = partial(_row, other, f"theta = {theta}, {end}")
    yield row(f"time of {other} / exact", "1", wall)
    yield row(f"processor time of {other} / exact", "1", cpu)
    for name, task in tasks.items():
        yield row(f"time of {name}", "ms", 1e3 * timings[name].seconds)
        for quantity, unit, value in errors_of(name, task(), truth):
            yield row(quantity, unit, value)


def ensemble(measure: Callable[..., Any], quick: bool) -> Iterable[Row]:
    """Runs per second to the first global slip of theta = 0, by `simulate_many` on one or
    more threads."""
    chains = [Chain.from_slider()] * (20 if quick else ENSEMBLE)
    threads = sorted({1, 2, untyped.config.NUMBA_DEFAULT_NUM_THREADS})
    tasks = {
        str(n): partial(simulate_many, chains, DURATION, "global slip", threads=n)
        for n in threads
    }
    timings = measure(tasks)
    for n in threads:
        row = partial(_row, "ensemble", f"{n} threads, {len(chains)} runs")
        faster, _ = timings[str(n)].times_faster_than(timings["1"])
        yield row(
            "first-slip runs a second and thread",
            "1/s",
            len(chains) / timings[str(n)].seconds / n,
        )
        yield row("of linear scaling", "1", faster / n)


def heyoka_ensemble(measure: Callable[..., Any], quick: bool) -> Iterable[Row]:
    """Compare `simulate_many` on one thread with heyoka.py, in its ensemble mode and run
    by run."""
    if not find_spec("heyoka"):
        return
    from heyoka_ensemble import Ensemble

    chain, n = Chain.from_slider(), 5 if quick else HEYOKA_ENSEMBLE
    many = Ensemble(chain, DURATION)
    tasks: dict[str, Callable[[], object]] = {
        "simulate_many": partial(
            simulate_many, [chain] * n, DURATION, "global slip", threads=1
        ),
        "heyoka's ensemble": partial(many.ends, n, 1),
        "heyoka, run by run": lambda: [
            solve_heyoka(chain, DURATION, HEYOKA_TOLERANCE, "global slip")
            for _ in range(n)
        ],
    }
    timings = measure(tasks)
    row = partial(_row, "ensemble", f"1 thread, {n} runs, theta = 0, first slip")
    for name in list(tasks)[1:]:
        _, cpu = timings["simulate_many"].times_faster_than(timings[name])
        yield row(f"processor time of {name} / simulate_many", "1", cpu)
    exact = simulate(chain, DURATION, "global slip").duration
    error = max(abs(end - exact) for end in many.ends(n, 1))
    yield row("largest error of an end, heyoka's ensemble", "s", error)


def in_callbacks() -> Iterable[Row]:
    """Median share of the processor time of heyoka.py and CVODE in our callbacks."""
    callbacks: dict[str, list[tuple[object, str]]] = {
        "heyoka": [(events.EventMotion, "switch")],
        "cvode_adams": [(cvode_events, "rates_of"), (cvode_events, "event_functions")],
    }
    for name in filter(METHODS.__contains__, callbacks):
        tightest = charted_values(full=False)[name][-1]
        run = partial(
            METHODS[name].solve,
            Chain.from_slider(),
            DURATION,
            tightest,
            "global slip",
        )
        run()
        part = median(part_within(run, callbacks[name]) for _ in range(timing.ROUNDS))
        yield _row(
            "callbacks",
            "theta = 0, to the first global slip",
            f"part of {name}'s time",
            "1",
            part,
        )


def part_within(
    run: Callable[[], object], functions: Iterable[tuple[object, str]]
) -> float:
    """Share of the processor time of a call that is spent in given functions."""
    within = 0.0

    def timed(function: Callable[..., Any]) -> Callable[..., Any]:
        def call(*arguments: Any) -> Any:
            nonlocal within
            start = process_time()
            result = function(*arguments)
            within += process_time() - start
            return result

        return call

    with ExitStack() as stack:
        for owner, name in functions:
            stack.enter_context(patch.object(owner, name, timed(getattr(owner, name))))
        start = process_time()
        run()
        return within / (process_time() - start)


def long_chains(measure: Callable[..., Any]) -> Iterable[Row]:
    """Ratio of the time of a transition of a long chain to that of a short one."""

    def run(n_blocks: int) -> None:
        chain = Chain.from_slider(n_blocks=n_blocks, drive_velocity=FAST_DRIVE)
        start = STRAIN * maximal_strain_positions(chain)
        with suppress(TransitionLimitError):
            simulate(
                chain,
                DURATION,
                start_positions=start,
                max_transitions=GROWTH_TRANSITIONS,
            )

    timings = measure({str(n): partial(run, n) for n in (LONG_CHAIN, SHORT_CHAIN)})
    _, cpu = timings[str(SHORT_CHAIN)].times_faster_than(timings[str(LONG_CHAIN)])
    case = f"N = {LONG_CHAIN}, strained, driven at {FAST_DRIVE:g} m/s"
    yield _row("growth", case, f"time of a transition / at N = {SHORT_CHAIN}", "1", cpu)


def _row(measurement: str, case: str, quantity: str, unit: str, value: float) -> Row:
    return {
        "measurement": measurement,
        "case": case,
        "quantity": quantity,
        "unit": unit,
        "value": value,
    }


if __name__ == "__main__":
    try:
        main()
    # A method that diverges or gives up raises a RuntimeError.
    except (RuntimeError, ValueError, OSError) as error:
        sys.exit(f"bench: {' '.join(str(error).split())}")
