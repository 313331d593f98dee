"""Speed against accuracy: methods over the values of their knobs, timed side by side, held to the truth."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from importlib import import_module
from typing import TYPE_CHECKING, Literal

import pandas as pd

from precursors import methods as integrators
from precursors.accuracy.compare import Truth, compare
from precursors.methods import METHODS, DivergedError, Method, Result
from precursors.model.chain import Chain
from precursors.solver.simulate import TransitionLimitError, simulate
from precursors.support import timing

if TYPE_CHECKING:
    from precursors.accuracy.proof import Certificate

Until = Literal["global slip"] | None
Sweeps = Mapping[str, Sequence[float]]

COLUMNS = [
    "scene",
    "theta",
    "until",
    "truth",
    "method",
    "label",
    "knob",
    "value",
    "evaluations",
    "seconds",
    "error_load_N",
    "error_time_s",
    "transitions_right",
    "transitions_found",
    "transitions_true",
    "slips_right",
    "slips_found",
    "slips_true",
]
END = "end"


@dataclass(frozen=True, eq=False)
class Case:
    """What all methods are asked to do.

    Attributes
    ----------
    scene : str
        Name of the scene.
    theta : float
        Degree of non-uniformity of its normal loading.
    chain : Chain
        The chain.
    duration : float
        Time [s], or its limit.
    until : "global slip" or None
        Where the run ends; None: after `duration`.
    truth : Truth
        The true run, over the same time.
    is_proved : bool
        Whether the truth has a proof; else it is the run of the exact solver.
    """

    scene: str
    theta: float
    chain: Chain
    duration: float
    until: Until
    truth: Truth
    is_proved: bool


def measure_methods(case: Case, sweeps: Sweeps, repetitions: int, longest: float) -> pd.DataFrame:
    """Time the methods over the values of their knobs, and compare each run with the truth.

    Parameters
    ----------
    case : Case
        What to run.
    sweeps : mapping
        Values of the knob for each method, from loose to tight; methods whose package is missing are left
        out.
    repetitions : int
        Number of rounds, after a warm-up, that the median is taken of; methods take turns in a round.
    longest : float
        Where a call takes longer [s], the sweep of its method ends before it.

    Returns
    -------
    DataFrame
        A row per method and value, with `COLUMNS`; `evaluations` is NaN for a method that counts none, and
        errors are those of `Comparison`, NaN for the exact solver where it is itself the truth.

    Raises
    ------
    ValueError
        If there is no method of a name.
    """
    check_methods(sweeps)
    tried = {
        f"{name} {attempt.value!r}": attempt
        for name, values in sweeps.items()
        if name in METHODS
        for attempt in _sweep(METHODS[name], values, case, longest)
    }
    timings = timing.measure(
        {key: attempt.call for key, attempt in tried.items()},
        repetitions,
        seconds={key: attempt.seconds for key, attempt in tried.items()},
    )
    return pd.DataFrame(
        [_row(case, attempt, timings[key].seconds) for key, attempt in tried.items()], columns=COLUMNS
    )


def proved_cases(scene: str, theta: float, certificate: Certificate) -> tuple[Case, Case]:
    """Make two cases of what a certificate proves: to the end of the first global slip, and to its own end.

    If a tie ends the proof, the truth is the run of the exact solver.
    """
    chain, duration = certificate.chain.to_chain(), float(certificate.duration)
    is_proved = certificate.tie is None
    start = [float(x) for x in certificate.start_positions]
    if any(start):
        raise ValueError(f"{scene} starts from {start} m: allowed is a start with springs at natural length")
    truth = Truth.proved(certificate) if is_proved else Truth.of_run(simulate(chain, duration))
    whole = Case(scene, theta, chain, duration, certificate.until, truth, is_proved)
    return replace(whole, until="global slip", truth=truth.until_global_slip()), whole


def sweeps_of(values: Mapping[str, Sequence[float] | str]) -> Sweeps:
    """Replace the word "sweep" by all values that the table of methods has for a method.

    Raises
    ------
    ValueError
        If there is no method of a name.
    """
    check_methods(values)
    return {
        name: METHODS[name].sweep if isinstance(wanted, str) else wanted
        for name, wanted in values.items()
        if name in METHODS
    }


def check_methods(names: Iterable[str]) -> None:
    """Refuse a name that is no method's, be its package installed or not.

    Raises
    ------
    ValueError
        In one line, with the names there are.
    """
    modules = [import_module(f"{integrators.__name__}.{module}") for module in integrators.MODULES]
    known = {method.name for module in modules for method in module.METHODS}
    for name in names:
        if name not in known:
            raise ValueError(f"there is no method {name!r}: allowed are {', '.join(sorted(known))}")


def outcome(method: Method, value: float, case: Case) -> Result:
    """Run a method; of a run that breaks off, what there is."""
    try:
        return method.solve(case.chain, case.duration, value, case.until)
    except (DivergedError, TransitionLimitError) as error:
        return Result(error.run, 0)


@dataclass(frozen=True)
class _Attempt:
    """A method with a value of its knob, its result, and about how long a call takes [s]."""

    method: Method
    value: float
    call: Callable[[], Result]
    result: Result
    seconds: float


def _sweep(method: Method, values: Sequence[float], case: Case, longest: float) -> Iterator[_Attempt]:
    for value in values:
        call = partial(outcome, method, value, case)
        result, seconds = timing.second_call(call)
        if seconds > longest:
            return
        yield _Attempt(method, value, call, result, seconds)


def _row(case: Case, attempt: _Attempt, seconds: float) -> dict[str, object]:
    method, result = attempt.method, attempt.result
    found = compare(result.run, case.truth)
    # The exact solver's distance from itself is no error.
    is_the_truth = method.name == "exact" and not case.is_proved
    return {
        "scene": case.scene,
        "theta": case.theta,
        "until": case.until or END,
        "truth": "proved" if case.is_proved else "exact solver",
        "method": method.name,
        "label": method.label,
        "knob": method.knob,
        "value": attempt.value,
        "evaluations": result.evaluations or math.nan,
        "seconds": seconds,
        "error_load_N": math.nan if is_the_truth else found.load_error,
        "error_time_s": math.nan if is_the_truth else found.time_error,
        "transitions_right": found.transitions_right,
        "transitions_found": found.transitions_found,
        "transitions_true": found.transitions_true,
        "slips_right": found.slips_right,
        "slips_found": found.slips_found,
        "slips_true": found.slips_true,
    }
