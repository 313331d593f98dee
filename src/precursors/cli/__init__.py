"""The command `precursors`: simulate, slips, plot, audit, score.

The modules of a command are imported when it runs, so that `precursors --help` is fast.
"""

import os
import sys
import warnings
from collections.abc import Sequence
from io import TextIOWrapper

from precursors.cli.options import WRONG_USE, read_options
from precursors.support.files import check_writable

DONE = 0
REFUSED = 1
FILE = 3
NOT_INSTALLED = 4
INTERRUPTED = 130
ENDINGS = {"plot": (".png", ".svg", ".pdf", ".eps"), "slips": (".csv", ".tsv")}


class Refused(Exception):
    """A check failed, or a limit was reached; each argument is one line for the user."""


def main(argv: Sequence[str] | None = None) -> int:
    """Run a command and return its exit code; an error is one line on standard
    error."""
    # The matrices are too small for threads.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    if isinstance(sys.stdout, TextIOWrapper):  # a terminal may lack some characters
        sys.stdout.reconfigure(errors="backslashreplace")
    warnings.formatwarning = lambda message, *_: f"precursors: {message}\n"
    arguments = read_options(sys.argv[1:] if argv is None else argv)
    try:
        if getattr(arguments, "output", None) is not None:
            is_wave = getattr(arguments, "figure", None) == "wave"
            endings = (".svg",) if is_wave else ENDINGS.get(arguments.command, ())
            check_writable(arguments.output, endings)
        from precursors.cli import commands

        getattr(commands, arguments.command)(arguments)
        if sys.stdout:  # None if it was closed
            sys.stdout.flush()
        return DONE
    except BrokenPipeError:  # as in `precursors slips | head`
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return DONE
    except KeyboardInterrupt:
        code = INTERRUPTED
        lines = ["interrupted"]
    except Refused as error:
        code = REFUSED
        lines = list(error.args)
    except ImportError as error:
        code = NOT_INSTALLED
        is_missing = isinstance(error, ModuleNotFoundError)
        lines = [f"{error}: install it to use this" if is_missing else str(error)]
    except (ValueError, MemoryError) as error:
        code = WRONG_USE
        lines = [str(error) or "not enough memory for so many blocks or runs"]
    except OSError as error:
        code = FILE
        lines = [
            f"{error.filename}: {error.strerror}" if error.filename else str(error)
        ]
    for line in lines:
        message = " ".join(line.split())
        print(f"precursors {arguments.command}: {message}", file=sys.stderr)
    return code
