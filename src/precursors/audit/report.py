"""The result of an audit."""

import math
from dataclasses import dataclass, field


@dataclass
class Audit:
    """Result of an audit.

    `problems` are at most `checks.MAX_PROBLEMS` sentences about deviations above the
    tolerance. `roundings` is the largest deviation of a force or a velocity, in
    roundings of a step. `is_undecided` is True if the only problem is that the audit
    takes too much work.
    """

    roundings: float = math.nan
    n_intervals: int = 0
    problems: list[str] = field(default_factory=list)
    is_undecided: bool = False

    @property
    def ok(self) -> bool:
        """Whether the run is a motion of the model within the tolerances."""
        return not self.problems

    def raise_if_failed(self) -> None:
        """Raise an ArithmeticError that lists the problems, if there are any."""
        if self.problems:
            raise ArithmeticError(str(self))

    def __str__(self) -> str:
        verdict = (
            "a motion" if self.ok else f"no motion ({len(self.problems)} problems)"
        )
        answer = f"The run is {verdict} of the model"
        if self.is_undecided:
            answer = "It is undecided whether the run is a motion of the model"
        summary = (
            f"{answer}: {self.n_intervals} intervals audited, "
            f"largest deviation {self.roundings:.1f} roundings."
        )
        return "\n".join([summary, *self.problems])
