"""The interface of the methods: their result, their kind, the error of a diverged
run."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from precursors.solver.run import Record
from precursors.solver.simulate import TransitionLimitError


@dataclass(frozen=True)
class Result:
    """The transitions that a method found, and its cost.

    `evaluations` is how often the forces of the whole chain were evaluated, whatever
    the machine.
    """

    run: Record
    evaluations: int


@dataclass(frozen=True)
class Smooth:
    """A fixed-step method while nothing switches: what is proved about it in theory.

    `slide` (system, state, step [s], number of steps) makes steps with all blocks
    sliding, see `fixed_step`. `limit` is the largest stable omega dt, for the highest
    angular frequency omega of the chain; `energy_factor` is the factor on the energy of
    a mode in one step, as a function of omega dt.
    """

    slide: Callable[..., None]
    limit: float
    energy_factor: Callable[[float], float]


@dataclass(frozen=True)
class Method:
    """A method by its name, which is its row in methods.csv.

    `setting` is what sets the accuracy, with its unit: "step [s]", "relative
    tolerance". `solve` is (chain, duration [s], value of the setting,
    until) -> Result; `until` is None or "global slip". `smooth` is the method without
    switching, where theory says something about it.
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
    """Result of a method; of a run that breaks off, what there is."""
    try:
        return solve(*arguments)
    except (DivergedError, TransitionLimitError) as error:
        return Result(error.run, 0)
