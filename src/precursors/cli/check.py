"""`precursors check`: the ledger of what the paper states, judged by the results."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from precursors.cli.exit_codes import ExitCode
from precursors.cli.output import print_json, print_table, records

NAME = "check"
HELP = "print the ledger: the paper's statements, each with its verdict"
DESCRIPTION = """\
Judge every checkable statement of the paper by the tables that `make all` wrote, and print the verdicts. Run
it in the repository, or say where the files are. The exit code is 1 if a verdict or number is not the one
expected, or not the one in the ledger that lies among the tables, claims.csv. `make check` is this command
with --full."""
EXAMPLES = """\
  precursors check --full
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
    parser.add_argument("--full", action="store_true", help="print statements and rules in full")


def run(arguments: argparse.Namespace) -> int:
    """Judge the claims, print them, and compare them with what is expected."""
    from precursors.reproduction.ledger.claims import read_claims
    from precursors.reproduction.ledger.judge import differences, judge, to_table
    from precursors.reproduction.ledger.text import counted, ledger_text
    from precursors.support.files import read_table

    # The ledger among the tables is of the same processor as they are; a user's tables may have none.
    expected = {arguments.expected: False}
    written = arguments.tables / "claims.csv"
    if written.is_file():
        expected[written] = True
    ledgers = {path: read_table(path, dtype=str, keep_default_na=False) for path in expected}
    found = to_table(judge(read_claims(arguments.claims), arguments.tables))
    unexpected = [
        f"{line} ({path})"
        for path, same_processor in expected.items()
        for line in differences(found, ledgers[path], same_processor)
    ]
    if arguments.json:
        print_json({"claims": records(found), "unexpected": unexpected})
    else:
        if arguments.full:
            print(ledger_text(found))
        else:
            print_table(found[["verdict", "id", "where", "paper", "ours", "unit"]])
        print(f"{len(found)} claims: {counted(found)}")
    for line in unexpected:
        print(f"precursors check: {line}", file=sys.stderr)
    return ExitCode.REFUSED if unexpected else ExitCode.DONE
