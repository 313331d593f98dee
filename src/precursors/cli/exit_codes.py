"""What the command line returns to the shell."""

from enum import IntEnum


class ExitCode(IntEnum):
    """Exit codes; they are part of the interface."""

    DONE = 0
    REFUSED = 1
    WRONG_USE = 2
    FILE = 3
    NOT_INSTALLED = 4
    INTERRUPTED = 130


EXIT_CODES = {
    ExitCode.DONE: "done, and all that was asked about holds",
    ExitCode.REFUSED: "a run file, certificate or claim does not hold, or a run met its cap on transitions",
    ExitCode.WRONG_USE: "an option is wrong, or a value out of range",
    ExitCode.FILE: "a file cannot be read or written",
    ExitCode.NOT_INSTALLED: "a package that this needs is not installed",
    ExitCode.INTERRUPTED: "interrupted (Ctrl-C)",
}


class Refused(Exception):
    """What was asked about does not hold; the message says what and why."""
