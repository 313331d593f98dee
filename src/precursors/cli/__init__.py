"""The command `precursors`: simulate, slips, plot, verify, bench, check.

Options are read by argparse, which is in every Python and imports in milliseconds. Everything else is
imported by the command that needs it, so that `precursors --help` answers at once.
"""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Sequence
from typing import NoReturn

from precursors.cli import bench, check, plot, simulate, slips, verify
from precursors.cli.arguments import join_negative_values
from precursors.cli.exit_codes import EXIT_CODES, ExitCode, Refused

COMMANDS = (simulate, slips, plot, verify, bench, check)
EXAMPLES = """\
examples:
  precursors simulate --theta 5/6                     10 s of the paper's chain, in a few lines
  precursors simulate --theta 5/6 --output run.h5     ... and keep the run
  precursors slips run.h5 --kept                      the events of Fig. 13
  precursors plot --theta 5/6 --blocks 20             a figure, on the screen or in a file
  precursors verify results/runs/*.h5                 is this what was computed, and a motion of the model?

`precursors COMMAND --help` has more of them."""


class Parser(argparse.ArgumentParser):
    """Says what is wrong in one line."""

    def error(self, message: str) -> NoReturn:
        """Leave with one line on stderr."""
        self.exit(ExitCode.WRONG_USE, f"{self.prog}: {message} (see {self.prog} --help)\n")


class _PrintVersion(argparse.Action):
    """Looks the version up only when it is asked for."""

    def __call__(self, parser: argparse.ArgumentParser, *_: object) -> NoReturn:
        from importlib.metadata import version

        print(f"precursors {version('precursors')}")
        parser.exit()


def main(argv: Sequence[str] | None = None) -> int:
    """Run a command and return its exit code (see `exit_codes`)."""
    parser = _parser()
    arguments = parser.parse_args(join_negative_values(sys.argv[1:] if argv is None else argv))
    command = f"{parser.prog} {arguments.command}"
    try:
        code: int = arguments.run(arguments)
        sys.stdout.flush()
    except BrokenPipeError:
        # Whoever read has enough, as in `precursors slips | head`; Python must not complain of it at its end.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return ExitCode.DONE
    except KeyboardInterrupt:
        return _failed(command, "interrupted", ExitCode.INTERRUPTED)
    except (Refused, ArithmeticError) as error:
        return _failed(command, str(error), ExitCode.REFUSED)
    except ModuleNotFoundError as error:
        return _failed(command, f"{error}: install it to use this", ExitCode.NOT_INSTALLED)
    except ValueError as error:
        return _failed(command, str(error), ExitCode.WRONG_USE)
    except OSError as error:
        reason = f"{error.filename}: {error.strerror}" if error.filename else str(error)
        return _failed(command, reason, ExitCode.FILE)
    except MemoryError:
        return _failed(command, "not enough memory for so many blocks or runs", ExitCode.WRONG_USE)
    return code


def _parser() -> Parser:
    codes = "\n".join(f"  {code.value:<5}{meaning}" for code, meaning in EXIT_CODES.items())
    parser = Parser(
        prog="precursors",
        description="Stick-slip chains solved exactly: precursors of global slip.",
        epilog=f"{EXAMPLES}\n\nexit codes:\n{codes}",
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--version", action=_PrintVersion, nargs=0, help="show the version and exit")
    subparsers = parser.add_subparsers(dest="command", metavar="COMMAND", required=True)
    for module in COMMANDS:
        command = subparsers.add_parser(
            module.NAME,
            help=module.HELP,
            description=module.DESCRIPTION,
            epilog=f"examples:\n{module.EXAMPLES}",
            formatter_class=argparse.RawDescriptionHelpFormatter,
        )
        module.add_arguments(command)
        command.add_argument("--json", action="store_true", help="write one JSON value to standard output")
        command.set_defaults(run=module.run)
    return parser


def _failed(command: str, message: str, code: ExitCode) -> int:
    print(f"{command}: {' '.join(message.split())}", file=sys.stderr)
    return code
