"""Scores of the result files of other solvers."""

from pathlib import Path

import pandas as pd

from precursors.benchmark.score import score


def score_table(solvers: pd.DataFrame, folder: str) -> pd.DataFrame:
    """Score the files SOLVER-PROBLEM.csv of a folder: a row for each of them."""
    rows = [
        solver | score(path, path.stem.rpartition("-")[2], solver["ties_s"])
        for solver in solvers.to_dict("records")
        for path in sorted(Path(folder).glob(f"{solver['solver']}-*.csv"))
    ]
    return pd.DataFrame(rows).drop(columns="ends_s")
