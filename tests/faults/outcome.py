"""What became of the trials of a fault, and the table of all of them."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field


@dataclass
class Outcome:
    """Trials of one fault.

    Parameters
    ----------
    fault : str
        What was done, in a few words.
    tried, survived, refused : int
        Trials, those that ended as if nothing had happened, and those that were refused in a sentence.
    lost : list of str
        Every other trial: what was done and what came of it.
    note : str
        What was not tried here, and why.
    """

    fault: str
    tried: int = 0
    survived: int = 0
    refused: int = 0
    lost: list[str] = field(default_factory=list)
    note: str = ""

    def count(self, verdict: str) -> None:
        """Add a trial: "survived", "refused", or a sentence that says how it was lost."""
        self.tried += 1
        if verdict == "survived":
            self.survived += 1
        elif verdict == "refused":
            self.refused += 1
        else:
            self.lost.append(verdict)

    def __iadd__(self, other: Outcome) -> Outcome:
        """Add the trials of the same fault that were counted elsewhere."""
        self.tried += other.tried
        self.survived += other.survived
        self.refused += other.refused
        self.lost += other.lost
        return self


def table(outcomes: Iterable[Outcome]) -> str:
    """The table that `make test-faults` prints."""
    rows = [("fault", "tried", "survived", "refused", "lost", "")]
    for outcome in outcomes:
        numbers = (outcome.tried, outcome.survived, outcome.refused, len(outcome.lost))
        rows.append((outcome.fault, *map(str, numbers), outcome.note))
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    return "\n".join(_line(row, widths) for row in rows)


def _line(row: Sequence[str], widths: Sequence[int]) -> str:
    first, *numbers, note = row
    cells = [first.ljust(widths[0]), *(n.rjust(w) for n, w in zip(numbers, widths[1:], strict=False))]
    return "  ".join([*cells, note]).rstrip()
