"""Check the existing results without recomputing them: print every claim with its verdict (`make check`).

The exit code is 1 if a verdict is not the expected one.
"""

import sys
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from textwrap import fill

import pandas as pd

from precursors.reproduction.claim import KINDS, VERDICTS
from precursors.reproduction.claims import differences, evaluate
from precursors.reproduction.tables import Tables
from precursors.support.files import read_table

WIDTH = 110


def main(tables: str | Path = "results/tables", expected: str | Path = "tests/golden/claims.csv") -> None:
    """Print the claims by the tables of a directory, and exit with 1 if a verdict is unexpected."""
    found = evaluate(Tables(tables))
    print("\n".join([*entries(found), *totals(found)]))
    unexpected = differences(found, read_table(expected, dtype=str, keep_default_na=False))
    if unexpected:
        sys.exit("\n".join(f"check: {line}" for line in unexpected))


def entries(claims: pd.DataFrame) -> Iterator[str]:
    """Each claim: its verdict, where it stands, what it says, and both numbers."""
    for number, claim in enumerate(claims.to_dict("records"), start=1):
        unit = "" if claim["unit"] == "1" else f" {claim['unit']}"
        paper, ours = (f"{claim[key]}{unit}" if claim[key] else "-" for key in ("paper", "ours"))
        yield f"{number:2d}  {claim['verdict'].upper()}  [{claim['id']}]  {claim['where']}"
        for line in (claim["statement"], f"paper: {paper}   ours: {ours}   ({claim['rule']})"):
            yield fill(line, WIDTH, initial_indent=" " * 4, subsequent_indent=" " * 4)


def totals(claims: pd.DataFrame) -> Iterator[str]:
    """How many claims of each kind have which verdict."""
    for name, kind in KINDS.items():
        verdicts = Counter(claims["verdict"][claims["kind"] == name])
        counts = ", ".join(f"{verdicts[verdict]} {verdict}" for verdict in VERDICTS if verdicts[verdict])
        yield fill(f"{verdicts.total()} of kind {name} ({kind.meaning}): {counts}", WIDTH)


if __name__ == "__main__":
    try:
        main(*sys.argv[1:])
    except (OSError, ValueError) as error:
        sys.exit(f"check: {error}")
