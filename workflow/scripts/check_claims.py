"""Judge the claims by the results as they lie there, print the ledger, and compare it with the golden one."""

from __future__ import annotations

import sys
from collections import Counter
from pathlib import Path
from textwrap import fill

import pandas as pd

from precursors.ledger.claims import read_claims
from precursors.ledger.judge import differences, judge, to_table
from precursors.ledger.rules import VERDICTS

WIDTH = 110
INDENT = "    "


def main(claims: str | Path, tables: str | Path, golden: str | Path) -> int:
    """Print the ledger; return 1 if a line of it differs from the golden one or from tables/claims.csv."""
    found = to_table(judge(read_claims(claims), tables))
    for number, (_, claim) in enumerate(found.iterrows(), start=1):
        print(entry(number, claim))
    counts = Counter(found["verdict"])
    print(f"{len(found)} claims: " + ", ".join(f"{counts[name]} {name}" for name in VERDICTS))
    complaints = []
    for path, same_processor in ((Path(golden), False), (Path(tables) / "claims.csv", True)):
        expected = pd.read_csv(path, dtype=str, keep_default_na=False)
        complaints += [f"{line} ({path})" for line in differences(found, expected, same_processor)]
    for complaint in complaints:
        print(f"DIFFERS  {complaint}")
    return 1 if complaints else 0


def entry(number: int, claim: pd.Series) -> str:
    """A claim for reading: its verdict, where it stands, what it says, and both numbers."""
    paper, ours = (with_unit(claim[key], claim["unit"]) for key in ("paper", "ours"))
    lines = [
        f"{number:2d}  {claim['verdict'].upper()}  [{claim['id']}]  {claim['where']}",
        claim["statement"],
        f"paper: {paper}   ours: {ours}   ({claim['rule']})",
    ]
    return "\n".join(
        fill(line, WIDTH, initial_indent=INDENT if i else "", subsequent_indent=INDENT)
        for i, line in enumerate(lines)
    )


def with_unit(text: str, unit: str) -> str:
    """Write the unit behind numbers, and a dash for none."""
    is_number = text[:1].isdigit() or text[:1] == "-"
    return f"{text} {unit}" if is_number and unit not in ("", "1") else text or "-"


if __name__ == "__main__":
    try:
        sys.exit(main(*sys.argv[1:]))
    except (ValueError, OSError) as error:
        sys.exit(f"ledger: {error}")
