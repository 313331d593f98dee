"""`precursors slips`: the slip events of a run as a table."""

from __future__ import annotations

import argparse
from pathlib import Path

from precursors.cli.arguments import add_run, run_of
from precursors.cli.exit_codes import ExitCode
from precursors.cli.output import print_json, print_table, records

NAME = "slips"
HELP = "list the slip events of a run"
DESCRIPTION = """\
List the slip events of a run file, or of a chain that is run: onset and end [s], F_X before and after [N],
the farthest block that slid (front), how many slid and how many at once, whether it is a global slip, and
whether Fig. 13 keeps it."""
EXAMPLES = """\
  precursors slips results/runs/fig10.h5
  precursors slips --theta 5/6 --until-global-slip --kept
  precursors slips run.h5 --output slips.csv
  precursors slips run.h5 --json"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the options of this command."""
    add_run(parser)
    parser.add_argument("--kept", action="store_true", help="only the events that Fig. 13 keeps")
    parser.add_argument("--output", type=Path, metavar="FILE.csv", help="write the table with every digit")


def run(arguments: argparse.Namespace) -> int:
    """Find the slips and write them."""
    from precursors.analysis.slip_table import slip_table
    from precursors.support.files import write_whole

    table = slip_table(run_of(arguments))
    if arguments.kept:
        table = table[table["kept"]]
    if arguments.output:
        with write_whole(arguments.output) as temporary:
            table.to_csv(temporary, index=False, lineterminator="\n")
    if arguments.json:
        print_json(records(table))
    elif arguments.output:
        print(f"{len(table)} events: {arguments.output}")
    else:
        print_table(table)
    return ExitCode.DONE
