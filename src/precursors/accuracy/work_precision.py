"""Speed against accuracy: methods with several settings, timed side by side and compared with the truth."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING, Literal

import pandas as pd

from precursors.accuracy.compare import Truth, compare
from precursors.methods import METHODS, DivergedError, Method, Result
from precursors.model.chain import Chain
from precursors.solver.simulate import TransitionLimitError, simulate
from precursors.support import timing

if TYPE_CHECKING:
    from precursors.accuracy.proof import Certificate

# Rounds of which a time is the median. In the default chart, a call that takes longer than `LONG` [s] is
# timed once: it is a mean over what else the machine does, as the short calls of a round together are.
ROUNDS, ROUNDS_FULL = 3, 5
LONG, LONG_FULL = 0.05, math.inf
# A method is given up at a setting with which one call takes longer [s]: in the default chart, in the
# full one.
LONGEST, LONGEST_FULL = 2.0, 5.0
# What a method compiles, loads or builds for a chain and a value, it does in a run that is so short [s].
WARM_UP = 0.4
SHORTEST = 0.0025  # s, of a round: see `timing.measure`
COUNTS = (
    "transitions_right",
    "transitions_found",
    "transitions_true",
    "slips_right",
    "slips_found",
    "slips_true",
)


@dataclass(frozen=True, eq=False)
class Case:
    """What all methods are asked to do: a scene's chain, for a duration [s] or until its first global slip.

    The true run goes over the same time; it is proved, or else the run of the exact solver.
    """

    scene: str
    theta: float
    chain: Chain
    duration: float
    until: Literal["global slip"] | None
    truth: Truth
    is_proved: bool

    def run(self, method: Method, value: float, duration: float | None = None) -> Result:
        """Run a method with a value of its setting; of a run that breaks off, what there is."""
        try:
            return method.solve(self.chain, duration or self.duration, value, self.until)
        except (DivergedError, TransitionLimitError) as error:
            return Result(error.run, 0)


def proved_cases(scene: str, theta: float, certificate: Certificate) -> tuple[Case, Case]:
    """Make two cases of what a certificate proves: to the end of the first global slip, and to its own end.

    If a tie ends the proof, the truth is the run of the exact solver.
    """
    chain, duration = certificate.chain.to_chain(), float(certificate.duration)
    start = [float(x) for x in certificate.start_positions]
    if any(start):
        raise ValueError(f"{scene} must start with springs at natural length, but starts from {start} m")
    is_proved = certificate.tie is None
    truth = Truth.proved(certificate) if is_proved else Truth.of_run(simulate(chain, duration))
    whole = Case(scene, theta, chain, duration, certificate.until, truth, is_proved)
    return replace(whole, until="global slip", truth=truth.until_global_slip()), whole


def work_precision_table(
    certificates: Mapping[str, Certificate], thetas: Mapping[str, float], full: bool
) -> pd.DataFrame:
    """Measure all methods on the proved chains, in both cases of each."""
    limits = (ROUNDS_FULL, LONGEST_FULL, LONG_FULL) if full else (ROUNDS, LONGEST, LONG)
    tables = [
        measure_methods(case, charted_values(case, full), *limits)
        for scene, certificate in certificates.items()
        for case in proved_cases(scene, thetas[scene], certificate)
    ]
    return pd.concat(tables, ignore_index=True)


def charted_values(case: Case, full: bool = False) -> dict[str, tuple[float, ...]]:
    """Values of each method's setting in the default chart or the full one, by name of the method."""
    return {name: method.values_of(case.until, full) for name, method in METHODS.items()}


def measure_methods(
    case: Case,
    values: Mapping[str, Sequence[float]],
    rounds: int = ROUNDS,
    longest: float = LONGEST,
    long: float = math.inf,
) -> pd.DataFrame:
    """Time methods with several settings, and compare each run with the truth.

    `values` of each method's setting go from loose to tight. A time is the median of some rounds in which
    methods take turns, after a short warm-up; a call that takes longer than `long` [s] is timed once. A
    method is given up at a value with which a call takes longer than `longest` [s].

    Returns
    -------
    DataFrame
        A row per method and value; `evaluations` is NaN for a method that counts none, and
        errors are those of `Comparison`, NaN for the exact solver where it is itself the truth.
    """
    attempts = [
        attempt for name, some in values.items() for attempt in _attempts(case, METHODS[name], some, longest)
    ]
    short = {key: of for key, of in enumerate(attempts) if of.seconds.wall <= long}
    timings = timing.measure(
        {key: partial(case.run, of.method, of.value) for key, of in short.items()},
        rounds,
        SHORTEST,
        seconds={key: of.seconds for key, of in short.items()},
    )
    seconds = [timings[k].seconds if k in short else of.seconds.wall for k, of in enumerate(attempts)]
    return pd.DataFrame(list(map(partial(_row, case), attempts, seconds)))


@dataclass(frozen=True)
class _Attempt:
    """A method with a value of its setting, its result, and how long a call took."""

    method: Method
    value: float
    result: Result
    seconds: timing.Seconds


def _attempts(case: Case, method: Method, values: Sequence[float], longest: float) -> Iterator[_Attempt]:
    for value in values:
        warm_up = partial(case.run, method, value, min(WARM_UP, case.duration))
        result, seconds = timing.second_call(partial(case.run, method, value), warm_up)
        if seconds.wall > longest:
            return
        yield _Attempt(method, value, result, seconds)


def _row(case: Case, attempt: _Attempt, seconds: float) -> dict[str, object]:
    method, result = attempt.method, attempt.result
    found = compare(result.run, case.truth)
    # The exact solver's distance from itself is no error.
    is_the_truth = method.name == "exact" and not case.is_proved
    return {
        "scene": case.scene,
        "theta": case.theta,
        "until": case.until or "end",
        "truth": "proved" if case.is_proved else "exact solver",
        "method": method.name,
        "label": method.label,
        "kind": method.kind,
        "color": method.look[0],
        "marker": method.look[1],
        "setting": method.setting,
        "value": attempt.value,
        "evaluations": result.evaluations or math.nan,
        "seconds": seconds,
        "error_load_N": math.nan if is_the_truth else found.load_error,
        "error_time_s": math.nan if is_the_truth else found.time_error,
        **{name: getattr(found, name) for name in COUNTS},
    }
