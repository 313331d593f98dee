"""`precursors check`: the ledger of what the paper states, judged by the results."""

from __future__ import annotations

import argparse
import sys
from collections import Counter
from pathlib import Path

from precursors.command_line.exit_codes import ExitCode
from precursors.command_line.output import print_json, print_table, records

NAME = "check"
HELP = "print the ledger: the paper's statements, each with its verdict"
DESCRIPTION = """\
Judge every checkable statement of the paper by the tables that `make all` wrote, and print the verdicts. Run
it in the repository, or say where the files are. The exit code is 1 if a verdict or number is not the one
expected. `make check` prints the same with the statements in full."""
EXAMPLES = """\
  precursors check
  precursors check --tables /data/results/tables --json"""

CLAIMS = Path("paper/claims.yaml")
TABLES = Path("results/tables")
EXPECTED = Path("tests/golden/claims.csv")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the options of this command."""
    files = (
        ("--claims", CLAIMS, "what the paper states, and the rule for each"),
        ("--tables", TABLES, "directory of the tables to judge by"),
        ("--expected", EXPECTED, "the verdicts that are expected"),
    )
    for option, default, meaning in files:
        parser.add_argument(option, type=Path, default=default, metavar="PATH", help=f"{meaning} ({default})")


def run(arguments: argparse.Namespace) -> int:
    """Judge the claims, print them, and compare them with what is expected."""
    import pandas as pd

    from precursors.ledger.claims import read_claims
    from precursors.ledger.judge import differences, judge, to_table

    expected = pd.read_csv(arguments.expected, dtype=str, keep_default_na=False)
    found = to_table(judge(read_claims(arguments.claims), arguments.tables))
    unexpected = differences(found, expected)
    if arguments.json:
        print_json({"claims": records(found), "unexpected": unexpected})
    else:
        print_table(found[["verdict", "id", "where", "paper", "ours", "unit"]])
        counts = Counter(found["verdict"])
        print(f"{len(found)} claims: " + ", ".join(f"{n} {verdict}" for verdict, n in counts.items()))
    for line in unexpected:
        print(f"precursors check: {line}", file=sys.stderr)
    return ExitCode.REFUSED if unexpected else ExitCode.DONE
