"""Check the existing results without recomputing them: print every claim with its
verdict (`make check`).

The exit code is 1 if a verdict is not the expected one.
"""

import sys
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from textwrap import fill

import pandas as pd

from precursors.reproduction.claim import ENSEMBLES, KINDS, VERDICTS
from precursors.reproduction.claims import differences, evaluate
from precursors.reproduction.inputs import CLAIM_TABLES
from precursors.support.files import read_table

WIDTH = 110


def main(
    tables: str | Path = "results/tables",
    expected: str | Path = "tests/golden/claims.csv",
) -> None:
    """Print the claims by the tables of a directory, and exit with 1 if a verdict is
    unexpected."""
    try:
        found = evaluate(
            {name: read_table(Path(tables, f"{name}.csv")) for name in CLAIM_TABLES}
        )
    except (OSError, ValueError) as error:
        sys.exit(f"check: {error}")
    print("\n".join([*entries(found), *totals(found)]))
    unexpected = differences(found, read_table(expected))
    if unexpected:
        sys.exit("\n".join(f"check: {line}" for line in unexpected))


def entries(claims: pd.DataFrame) -> Iterator[str]:
    """Each claim: its verdict, section and statement, its numbers, and its shares of
    the ensembles."""
    for number, claim in enumerate(claims.to_dict("records"), start=1):
        unit = "" if claim["unit"] == "1" else f" {claim['unit']}"
        compared = f" ({claim['expected']}{unit})" if claim["expected"] else ""
        shares = [
            f"{100 * claim[f'{name}_share']:.0f} % of the draws of {name}"
            for name in ENSEMBLES
            if pd.notna(claim[f"{name}_share"])
        ]
        yield f"{number:2d}  {claim['verdict'].upper()}  [{claim['claim']}]  {claim['section']}"
        evidence = "; ".join(
            [f"{claim['ours']}{unit}{compared}: {claim['rule']}", *shares]
        )
        for line in (claim["statement"], evidence):
            yield fill(line, WIDTH, initial_indent=" " * 4, subsequent_indent=" " * 4)


def totals(claims: pd.DataFrame) -> Iterator[str]:
    """How many claims of each kind have which verdict."""
    for kind in KINDS:
        verdicts = Counter(claims["verdict"][claims["kind"] == kind])
        counts = ", ".join(
            f"{verdicts[verdict]} {verdict}"
            for verdict in VERDICTS
            if verdicts[verdict]
        )
        yield f"{verdicts.total()} of kind {kind!r}: {counts}"


if __name__ == "__main__":
    main(*sys.argv[1:])
