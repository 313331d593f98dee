"""`precursors bench`: how fast the exact solver is on this machine, beside other methods."""

from __future__ import annotations

import argparse
import os
from functools import partial
from typing import TYPE_CHECKING

from precursors.cli.arguments import whole
from precursors.cli.exit_codes import ExitCode
from precursors.cli.output import print_json, print_table
from precursors.support.progress import Progress

if TYPE_CHECKING:
    from precursors.methods import Method
    from precursors.model.chain import Chain
    from precursors.solver.run import Run

NAME = "bench"
HELP = "time the exact solver beside other methods"
DESCRIPTION = """\
Time the exact solver and other methods, each at its most accurate setting, in turn and on one core:
the paper's chain at theta = 0 to the end of the first global slip. Ratios to the exact solver are medians
over rounds. `make bench` in the repository has more cases, and errors against a reference in 40 digits."""
EXAMPLES = """\
  precursors bench
  precursors bench --methods exact scipy_dop853 karnopp --rounds 3
  precursors bench --json"""

DEFAULT_METHODS = ("exact", "heyoka", "scipy_dop853")
ROUNDS = 5
DURATION = 10.0  # s, a limit that no right run meets


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the options of this command."""
    parser.add_argument(
        "--methods",
        nargs="+",
        metavar="NAME",
        help='methods; "all" for all of them, "list" to see their names',
    )
    parser.add_argument("--rounds", type=whole, default=ROUNDS, metavar="N", help=f"rounds ({ROUNDS})")


def run(arguments: argparse.Namespace) -> int:
    """Time the methods in turn and print a row each."""
    # Read by NumPy and Numba when they are imported: what is compared runs on one thread.
    for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS"):
        os.environ.setdefault(name, "1")
    with Progress("compiling"):
        import pandas as pd

        from precursors.accuracy.compare import Truth, compare
        from precursors.methods import METHODS
        from precursors.model import chain as parameters
        from precursors.support import timing
    if arguments.methods == ["list"]:
        print_json(list(METHODS)) if arguments.json else print(*METHODS, sep="\n")
        return ExitCode.DONE
    methods = _chosen(METHODS, arguments.methods)
    rounds = parameters.whole("rounds", arguments.rounds, at_least=1)
    chain = parameters.Chain.from_slider()
    with Progress("timing"):
        tasks = {name: partial(_solve, method, chain) for name, method in methods.items()}
        timings = timing.measure(tasks, rounds)
        runs = {name: task() for name, task in tasks.items()}
    truth = Truth.of_run(runs["exact"])
    rows = [
        {
            "method": name,
            "time_ms": 1e3 * timings[name].seconds,
            "times_slower": timings["exact"].times_faster_than(timings[name])[0],
            "transitions": len(run.transitions),
            "same_as_exact": compare(run, truth).transitions_right,
        }
        for name, run in runs.items()
    ]
    print_json(rows) if arguments.json else print_table(pd.DataFrame(rows))
    return ExitCode.DONE


def _chosen(methods: dict[str, Method], names: list[str] | None) -> dict[str, Method]:
    """The methods asked for, the exact one first."""
    if names is None:
        names = [name for name in DEFAULT_METHODS if name in methods]
    elif names == ["all"]:
        names = list(methods)
    for name in names:
        if name not in methods:
            raise ValueError(f"--methods {name}: no such method here: allowed are {', '.join(methods)}")
    return {name: methods[name] for name in dict.fromkeys(["exact", *names])}


def _solve(method: Method, chain: Chain) -> Run:
    return method.solve(chain, DURATION, method.sweep[-1], "global slip").run
