"""Solve the problems of docs/benchmark.md by the project's own methods.

.venv/bin/python benchmarks/own_results.py [METHOD ...]

Writes benchmarks/results/METHOD-PROBLEM.csv, in some two minutes for all of them.
"""

import sys
from pathlib import Path
from time import perf_counter

import pandas as pd

from maegawa2010.methods import METHODS, attempt
from precursors.benchmark.score import problems
from precursors.proof import Certificate
from precursors.support.files import write_table

RESULTS = Path(__file__).parent / "results"
# The tightest setting of each method in the full chart, by name.
BEST = {
    "exact": 0.0,
    "rk4_located": 3e-8,
    "leapfrog": 1e-9,
    "moreau_jean_half": 1e-9,
}
WARM_UP = 0.01  # s


def main(names: list[str]) -> None:
    for problem, path in problems().items():
        certificate = Certificate.load(path)
        chain = certificate.chain.to_chain()
        duration = float(certificate.duration)
        for name in names or BEST:
            solve = METHODS[name].solve
            attempt(solve, chain, WARM_UP, BEST[name], None)
            began = perf_counter()
            result = attempt(solve, chain, duration, BEST[name], None)
            seconds = perf_counter() - began
            table = pd.DataFrame(result.run.transitions)
            table.columns = ["time_s", "block", "mode", "tangential_load_N"]
            last = table.index[-1:]
            table.loc[last, "evaluations"] = result.evaluations or None
            table.loc[last, "seconds"] = round(seconds, 4)
            write_table(table, RESULTS / f"{name}-{problem}.csv")
            print(f"{name}, {problem}: {len(table)} transitions, {seconds:.2f} s")


if __name__ == "__main__":
    main(sys.argv[1:])
