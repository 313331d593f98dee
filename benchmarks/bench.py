"""The speed of the exact solver beside that of others, each with its error against the 40-digit reference.

    make bench                                            everything, some minutes
    .venv/bin/python benchmarks/bench.py --quick          a reduced size, to see that it runs

Ratios are what counts: all that is compared runs in turn in one process on one thread (see `timing`).
"""

from __future__ import annotations

import timing  # before NumPy: it sets the number of threads

# isort: split
import argparse
import csv
import math
import os
import sys
from collections.abc import Callable, Iterable
from dataclasses import astuple, dataclass, fields
from fractions import Fraction
from functools import partial
from importlib.util import find_spec
from pathlib import Path
from typing import Any, Literal

import numpy as np

import precursors
from precursors import Chain, Run, TransitionLimitError, simulate
from precursors.bound import maximal_strain_positions
from precursors.integrators.heyoka_events import solve_heyoka
from precursors.integrators.scipy_events import solve_scipy

ROOT = Path(__file__).resolve().parent.parent
REFERENCE = ROOT / "tests" / "golden" / "reference_fig10.csv"
TABLE = ROOT / "results" / "tables" / "bench.csv"
DURATION = 10.0  # s, the limit where a run ends by itself
FIRST_SLIP = 216  # transitions to the end of the first global slip of theta = 0
HEYOKA_TOLERANCE = 0.0  # its default, rounding
DOP853_TOLERANCE = 1e-13
# Growth: a slider strained to near the maximum.
SIZES = (5, 10, 20, 50, 100, 200, 500)
BASE_SIZE = 10
LEAST_FRONT = 50
FAST_DRIVE = 0.02  # m/s
NOTHING_HAPPENS = 1e-9  # s
STRAIN = 0.9  # of the maximal one
LEAST_TRANSITIONS, TRANSITIONS_PER_BLOCK = 4000, 30
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


@dataclass(frozen=True)
class Transition:
    """A golden transition: time [s], block and mode."""

    time: Fraction
    block: int
    mode: int


def main() -> None:
    """Run the benchmarks, print the table and write it."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--quick", action="store_true", help="a reduced size, to see that it runs")
    parser.add_argument("--output", type=Path, default=TABLE, help="the CSV file (%(default)s)")
    arguments = parser.parse_args()
    size = QUICK if arguments.quick else Size()
    rows: list[Row] = []
    for benchmark in (against_heyoka, against_dop853, growth, ensemble):
        for row in benchmark(size):
            print(
                f"{row.benchmark:12} {row.case:36} {row.quantity:46} {row.value:10.4g} {row.unit}", flush=True
            )
            rows.append(row)
    arguments.output.parent.mkdir(parents=True, exist_ok=True)
    with arguments.output.open("w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(field.name for field in fields(Row))
        writer.writerows(map(astuple, rows))


def against_heyoka(size: Size) -> Iterable[Row]:
    """The exact solver and heyoka.py at its default tolerance, theta = 0."""
    if not find_spec("heyoka"):
        print("heyoka.py is not installed: left out", file=sys.stderr)
        return
    chain = Chain.from_slider()
    cases: tuple[tuple[str, Literal["global slip"] | None, int], ...] = (
        ("theta = 0 to the first global slip", "global slip", FIRST_SLIP),
        ("theta = 0, 10 s", None, len(reference())),
    )
    for case, until, n_transitions in cases:
        tasks: dict[str, Callable[[], Run]] = {
            "exact": partial(simulate, chain, DURATION, until),
            "heyoka": partial(heyoka, chain, until),
        }
        yield from compare("heyoka", case, tasks, n_transitions, size)


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
    yield from compare("DOP853", "theta = 0 to the first global slip", tasks, FIRST_SLIP, size)


def compare(
    benchmark: str, case: str, tasks: dict[str, Callable[[], Run]], n_transitions: int, size: Size
) -> Iterable[Row]:
    """How many times faster the first task is than the second, and the errors of both."""
    exact, other = tasks
    timings = timing.measure(tasks, size.rounds, size.shortest)
    wall, cpu = timings[exact].times_faster_than(timings[other])
    row = partial(Row, benchmark, case)
    yield row(f"time of {other} / {exact}", "1", wall)
    yield row(f"processor time of {other} / {exact}", "1", cpu)
    for name, task in tasks.items():
        right, error = accuracy(task(), reference()[:n_transitions])
        yield row(f"time of {name}", "ms", 1e3 * timings[name].seconds)
        yield row(f"transitions of {name} right, of {n_transitions}", "1", right)
        yield row(f"largest error of their times, {name}", "s", error)


def growth(size: Size) -> Iterable[Row]:
    """Time per transition against the number of blocks, in a slider strained to near the maximum.

    "driven": a fast drive keeps the slider slipping for thousands of transitions.
    "front": the first slip event, whose front runs through all blocks; each lets go and stops once or twice.
    The cost of a call that makes no transition is subtracted, and shorter chains are left out: at N = 10 the
    event has 20 transitions, which cannot be measured beside the call. The base is that of "driven".
    """
    tasks: dict[str, Callable[[], Run]] = {}
    for n in size.sizes:
        chain = Chain.from_slider(n_blocks=n)
        start = STRAIN * maximal_strain_positions(chain)
        tasks[f"front {n}"] = partial(simulate, chain, DURATION, "global slip", start)
        tasks[f"call {n}"] = partial(simulate, chain, NOTHING_HAPPENS, None, start)
        tasks[f"driven {n}"] = driven_slip(n, size)
    timings = timing.measure(tasks, size.rounds, size.shortest)
    runs = {name: task() for name, task in tasks.items() if not name.startswith("call")}
    base = math.nan
    for kind, sizes in (("driven", size.sizes), ("front", [n for n in size.sizes if n >= LEAST_FRONT])):
        for n in sizes:
            run, times = runs[f"{kind} {n}"], np.array(timings[f"{kind} {n}"].cpu)
            if kind == "front":
                times -= timings[f"call {n}"].cpu
            seconds = float(np.median(times)) / len(run.transitions)
            if (kind, n) == ("driven", BASE_SIZE):
                base = seconds
            row = partial(Row, "growth", f"{kind}, N = {n}, {len(run.transitions)} transitions")
            yield row("time per transition", "us", 1e6 * seconds)
            yield row("farthest sliding block, mean / N", "1", mean_front(run) / n)
            if n >= BASE_SIZE:
                yield row(f"time per transition / N = {BASE_SIZE}", "1", seconds / base)


def driven_slip(n_blocks: int, size: Size) -> Callable[[], Run]:
    """A run of a fast, strained slider, just long enough for the wanted number of transitions."""
    chain = Chain.from_slider(n_blocks=n_blocks, drive_velocity=FAST_DRIVE)
    start = STRAIN * maximal_strain_positions(chain)
    wanted = max(size.least_transitions, size.transitions_per_block * n_blocks)
    try:
        run = simulate(chain, DURATION, start_positions=start, max_transitions=wanted)
    except TransitionLimitError as limit:
        run = limit.run
    return partial(simulate, chain, float(run.transitions["time"][-1]), None, start)


def mean_front(run: Run) -> float:
    """Farthest sliding block, averaged over the transitions of a run."""
    slides = np.zeros(run.chain.n_blocks, bool)
    fronts = []
    for block, mode in zip(run.transitions["block"], run.transitions["mode"], strict=True):
        slides[block - 1] = mode != 0
        fronts.append(int(np.flatnonzero(slides)[-1]) + 1 if slides.any() else 0)
    return float(np.mean(fronts))


def ensemble(size: Size) -> Iterable[Row]:
    """First-slip runs of theta = 0 per second, by `simulate_many` on one thread and more."""
    if not hasattr(precursors, "simulate_many"):
        print("precursors.simulate_many is not there: left out", file=sys.stderr)
        return
    chains = [Chain.from_slider()] * size.ensemble
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    threads = sorted({1, 2, cores})
    simulate_many: Any = precursors.simulate_many
    tasks = {str(n): partial(simulate_many, chains, DURATION, "global slip", threads=n) for n in threads}
    timings = timing.measure(tasks, size.rounds, size.shortest)
    for n in threads:
        row = partial(Row, "ensemble", f"{n} threads, {size.ensemble} runs")
        faster, _ = timings[str(n)].times_faster_than(timings["1"])
        yield row("first-slip runs a second and thread", "1/s", size.ensemble / timings[str(n)].seconds / n)
        yield row("of linear scaling", "1", faster / n)


def reference() -> list[Transition]:
    """The transitions of theta = 0 with 40 digits."""
    with REFERENCE.open(newline="") as file:
        return [
            Transition(Fraction(row["time_s"]), int(row["block"]), int(row["mode"]))
            for row in csv.DictReader(file)
        ]


def accuracy(run: Run, golden: list[Transition]) -> tuple[int, float]:
    """Transitions before the first wrong one, and the largest error of their times [s]."""
    right, error = 0, 0.0
    for transition, true in zip(run.transitions, golden, strict=False):
        if (transition["block"], transition["mode"]) != (true.block, true.mode):
            break
        error = max(error, abs(float(Fraction(float(transition["time"])) - true.time)))
        right += 1
    return right, error


if __name__ == "__main__":
    main()
