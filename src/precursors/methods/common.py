"""What all methods share: their result, their row in the table of methods, the error of
a diverged run."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Literal

from precursors.model.chain import Chain
from precursors.solver.run import Run


@dataclass(frozen=True)
class Result:
    """What a method returns: a run without states, so that `run.at` is refused, and
    what it cost.

    `evaluations` is how often the forces of the whole chain were evaluated, whatever
    the machine.
    """

    run: Run
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
    order: int
    limit: float
    energy_factor: Callable[[float], float]


# How a method finds its transitions: as roots, at the end of each step, or not at all,
# where friction is a function of the velocity.
Kind = Literal["located", "once a step", "friction law"]


@dataclass(frozen=True)
class Method:
    """A row of the table of methods: its key and its name in charts.

    `setting` is what sets the accuracy, with its unit: "step [s]", "relative
    tolerance", "width [m/s]". `solve` is (chain, duration [s], value of the setting,
    until) -> Result; `until` is None or "global slip". `values` of the setting, from
    loose to tight, are those of the full chart up to the first global slip and `whole`
    those for the whole run; `quick` and `quick_whole` are those of the default chart,
    which takes seconds. `smooth` is the method without switching, where theory says
    something about it. `look` is its colour and Matplotlib's name of its marker
    ("3,1,180" is a tuple); by default what no other has.
    """

    name: str
    label: str
    setting: str
    solve: Callable[[Chain, float, float, str | None], Result]
    values: tuple[float, ...]
    whole: tuple[float, ...] = ()
    quick: tuple[float, ...] = ()
    quick_whole: tuple[float, ...] = ()
    smooth: Smooth | None = None
    kind: Kind = "located"
    look: tuple[str, str] = ("", "")

    def values_of(self, until: Any, full: bool) -> tuple[float, ...]:
        """Values to chart up to the first global slip (`until`) or for the whole run
        (None)."""
        if full:
            return self.values if until else self.whole
        return self.quick if until else self.quick_whole


class DivergedError(RuntimeError):
    """The numbers overflowed; `run` holds what was computed before."""

    def __init__(self, message: str, run: Run) -> None:
        super().__init__(message)
        self.run = run
