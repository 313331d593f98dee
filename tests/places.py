"""Paths that several tests need, and tables of the build."""

from pathlib import Path

import pandas as pd

ROOT = Path(__file__).parents[1]
RESULTS = ROOT / "results"
GOLDEN = ROOT / "tests/golden"
CERTIFICATES = ROOT / "src/precursors/benchmark/certificates"


def made(name: str) -> pd.DataFrame:
    """A table of `make all`."""
    return pd.read_csv(RESULTS / f"tables/{name}.csv")
