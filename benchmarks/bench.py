"""The speed of the exact solver beside that of others, each with its error against the 40-digit reference.

    make bench                                            everything, in a minute or two
    .venv/bin/python benchmarks/bench.py --quick          a reduced size, to see that it runs

Ratios are what counts: all that is compared runs in turn in one process on one thread (see
`precursors.support.timing`).
"""

from __future__ import annotations

import os

# Before NumPy and Numba are imported.
os.environ |= dict.fromkeys(
    ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS"), "1"
)

# isort: split
import argparse
import csv
import sys
from collections.abc import Callable, Iterable
from dataclasses import astuple, dataclass, fields
from fractions import Fraction
from functools import cache, partial
from importlib.util import find_spec
from pathlib import Path
from typing import Literal

from precursors import Chain, Run, simulate, simulate_many
from precursors.accuracy.compare import TrueTransition, Truth, compare
from precursors.accuracy.cost_per_event import (
    BASE_SIZE,
    LEAST_TRANSITIONS,
    SIZES,
    TRANSITIONS_PER_BLOCK,
    measure_cost,
)
from precursors.methods.heyoka_events import solve_heyoka
from precursors.methods.scipy_events import solve_scipy
from precursors.solver.simulate import available_cores
from precursors.support import timing
from precursors.support.files import write_whole

ROOT = Path(__file__).resolve().parent.parent
REFERENCE = ROOT / "tests" / "golden" / "reference_fig10.csv"
TABLE = ROOT / "results" / "tables" / "bench.csv"
DURATION = 10.0  # s, the limit where a run ends by itself
HEYOKA_TOLERANCE = 0.0  # its default, rounding
DOP853_TOLERANCE = 1e-13
ENSEMBLE = 2000


@dataclass(frozen=True)
class Size:
    """How much to do."""

    rounds: int = timing.ROUNDS
    shortest: float = timing.SHORTEST
    sizes: tuple[int, ...] = SIZES
    least_transitions: int = LEAST_TRANSITIONS
    transitions_per_block: int = TRANSITIONS_PER_BLOCK
    ensemble: int = ENSEMBLE


QUICK = Size(
    rounds=2, shortest=0.0, sizes=(5, 10, 50), least_transitions=200, transitions_per_block=5, ensemble=20
)


@dataclass(frozen=True)
class Row:
    """One number of the table."""

    benchmark: str
    case: str
    quantity: str
    unit: str
    value: float


def main() -> None:
    """Run the benchmarks, print the table and write it."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--quick", action="store_true", help="a reduced size, to see that it runs")
    parser.add_argument("--output", type=Path, default=TABLE, help="the CSV file (%(default)s)")
    arguments = parser.parse_args()
    size = QUICK if arguments.quick else Size()
    rows: list[Row] = []
    for benchmark in (against_heyoka, against_dop853, cost_per_event, ensemble):
        for row in benchmark(size):
            print(
                f"{row.benchmark:12} {row.case:36} {row.quantity:46} {row.value:10.4g} {row.unit}", flush=True
            )
            rows.append(row)
    with write_whole(arguments.output) as temporary, temporary.open("w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(field.name for field in fields(Row))
        writer.writerows(map(astuple, rows))


def against_heyoka(size: Size) -> Iterable[Row]:
    """The exact solver and heyoka.py at its default tolerance, theta = 0."""
    if not find_spec("heyoka"):
        print("heyoka.py is not installed: left out", file=sys.stderr)
        return
    chain = Chain.from_slider()
    cases: tuple[tuple[str, Literal["global slip"] | None, Truth], ...] = (
        ("theta = 0 to the first global slip", "global slip", reference().until_global_slip()),
        ("theta = 0, 10 s", None, reference()),
    )
    for case, until, truth in cases:
        tasks: dict[str, Callable[[], Run]] = {
            "exact": partial(simulate, chain, DURATION, until),
            "heyoka": partial(heyoka, chain, until),
        }
        yield from compared("heyoka", case, tasks, truth, size)


def heyoka(chain: Chain, until: Literal["global slip"] | None) -> Run:
    """heyoka.py at its default tolerance."""
    return solve_heyoka(chain, DURATION, HEYOKA_TOLERANCE, until).run


def against_dop853(size: Size) -> Iterable[Row]:
    """The exact solver and SciPy's DOP853 at its tightest, theta = 0 to the end of the first global slip."""
    chain = Chain.from_slider()
    tasks = {
        "exact": lambda: simulate(chain, DURATION, "global slip"),
        "DOP853": lambda: solve_scipy(chain, DURATION, DOP853_TOLERANCE, "global slip").run,
    }
    truth = reference().until_global_slip()
    yield from compared("DOP853", "theta = 0 to the first global slip", tasks, truth, size)


def compared(
    benchmark: str, case: str, tasks: dict[str, Callable[[], Run]], truth: Truth, size: Size
) -> Iterable[Row]:
    """How many times faster the first task is than the second, and the errors of both."""
    exact, other = tasks
    timings = timing.measure(tasks, size.rounds, size.shortest)
    wall, cpu = timings[exact].times_faster_than(timings[other])
    row = partial(Row, benchmark, case)
    yield row(f"time of {other} / {exact}", "1", wall)
    yield row(f"processor time of {other} / {exact}", "1", cpu)
    for name, task in tasks.items():
        found = compare(task(), truth)
        yield row(f"time of {name}", "ms", 1e3 * timings[name].seconds)
        yield row(f"transitions of {name} right, of {found.transitions_true}", "1", found.transitions_right)
        yield row(f"largest error of their times, {name}", "s", found.time_error)
        yield row(f"largest error of F_X at slip onsets, {name}", "N", found.load_error)


def cost_per_event(size: Size) -> Iterable[Row]:
    """Time per transition against the number of blocks, see `measure_cost`."""
    table = measure_cost(size.sizes, size.rounds, size.least_transitions, size.transitions_per_block)
    for of in table.to_dict("records"):
        row = partial(Row, "cost", f"{of['kind']}, N = {of['n_blocks']}, {of['transitions']} transitions")
        yield row("time per transition", "us", 1e6 * of["seconds_per_transition"])
        yield row(f"time per transition / N = {BASE_SIZE}", "1", of["relative"])


def ensemble(size: Size) -> Iterable[Row]:
    """First-slip runs of theta = 0 per second, by `simulate_many` on one thread and more."""
    chains = [Chain.from_slider()] * size.ensemble
    threads = sorted({1, 2, available_cores()})
    tasks = {str(n): partial(simulate_many, chains, DURATION, "global slip", threads=n) for n in threads}
    timings = timing.measure(tasks, size.rounds, size.shortest)
    for n in threads:
        row = partial(Row, "ensemble", f"{n} threads, {size.ensemble} runs")
        faster, _ = timings[str(n)].times_faster_than(timings["1"])
        yield row("first-slip runs a second and thread", "1/s", size.ensemble / timings[str(n)].seconds / n)
        yield row("of linear scaling", "1", faster / n)


@cache
def reference() -> Truth:
    """The transitions of theta = 0 with 40 digits."""
    with REFERENCE.open(encoding="utf-8", newline="") as file:
        rows = [
            TrueTransition(
                Fraction(row["time_s"]),
                int(row["block"]),
                int(row["mode"]),
                Fraction(row["tangential_load_N"]),
            )
            for row in csv.DictReader(file)
        ]
    return Truth.exact(Chain.from_slider(), DURATION, rows)


if __name__ == "__main__":
    try:
        main()
    # A method that diverged or gave up raises a RuntimeError.
    except (RuntimeError, ValueError, OSError) as error:
        sys.exit(f"bench: {' '.join(str(error).split())}")
