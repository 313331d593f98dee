"""The interface of the methods: a method, its result, and the error of a diverged run."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from precursors.solver.run import Record
from precursors.solver.simulate import TransitionLimitError


@dataclass(frozen=True)
class Result:
    """The run that a method computed, and its cost.

    `evaluations` counts evaluations of the forces of the whole chain, a measure of cost
    that does not depend on the machine.
    """

    run: Record
    evaluations: int


@dataclass(frozen=True)
class Smooth:
    """A fixed-step method between transitions, where theory predicts its errors.

    `slide(system, state, step [s], number of steps)` makes steps with all blocks
    sliding (see `march.slide`). `limit` is the largest stable omega dt, for the highest
    angular frequency omega of the chain. `energy_factor` is the factor by which a step
    multiplies the energy of a mode, as a function of omega dt.
    """

    slide: Callable[..., None]
    limit: float
    energy_factor: Callable[[float], float]


@dataclass(frozen=True)
class Method:
    """A numerical method; `name` is its key in methods.csv.

    `setting` names the parameter that sets the accuracy, with its unit: "step [s]" or
    "relative tolerance". `solve` is (chain, duration [s], value of the setting,
    until) -> Result; `until` is None or "global slip". `smooth` is the method between
    transitions, if theory predicts its errors.
    """

    name: str
    setting: str
    solve: Callable[..., Result]
    smooth: Smooth | None = None


class DivergedError(RuntimeError):
    """The numbers overflowed; `run` holds what was computed before."""

    def __init__(self, message: str, run: Record) -> None:
        super().__init__(message)
        self.run = run


def attempt(solve: Callable[..., Result], *arguments: Any) -> Result:
    """Result of a method; if its run breaks off, the part that was computed."""
    try:
        return solve(*arguments)
    except (DivergedError, TransitionLimitError) as error:
        return Result(error.run, 0)
