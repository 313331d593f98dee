"""Do the paper's six numbers tell its theta? Runge and Kutta's method with steps drawn at random.

The paper's step is not known. A draw is one step, the same for theta < 0, theta = 0 and theta > 0. It gives
six numbers, as the paper prints: three counts and three mu_sapp.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike

from precursors.analysis.run_statistics import share_interval
from precursors.analysis.slips import apparent_friction, find_slips
from precursors.methods.columns import SWITCHING_RULES
from precursors.methods.fixed_step import march
from precursors.methods.rk4 import run_rk4
from precursors.model.chain import Chain, parse_theta
from precursors.reproduction.definitions import DIGITS, LAST_DIGIT, READING

SIX = [f"{name}_{sign}" for name in ("events", "mu_sapp") for sign in ("trailing", "uniform", "leading")]
# mu_sapp differs by a unit of its last digit at most: the comparison is not to depend on rounding.
WITHIN = LAST_DIGIT + 1e-12


def draws_table(
    slider: Mapping[str, Any],
    duration: float,
    degrees: Iterable[float | str],
    settings: Mapping[str, Any],
    n: int,
) -> pd.DataFrame:
    """One row for each size of theta, rule of switching and step: the six numbers, NaN without a global slip.

    `slider` has the arguments of `Chain.from_slider` but theta; `settings` has seed and steps, the smallest
    and the largest [s]. The logarithms of the n steps are uniform.
    """
    random = np.random.default_rng(settings["seed"])
    shortest, longest = np.log(settings["steps"])
    steps = np.exp(random.uniform(shortest, longest, n))
    rows = []
    for rule in SWITCHING_RULES:
        uniform = [six_part(slider, 0.0, duration, step, rule) for step in steps]
        for degree in degrees:
            theta = parse_theta(degree)
            for step, middle in zip(steps, uniform, strict=True):
                parts = (
                    six_part(slider, -theta, duration, step, rule),
                    middle,
                    six_part(slider, theta, duration, step, rule),
                )
                numbers = dict(zip(SIX, np.transpose(parts).ravel(), strict=True))
                rows.append({"degree": degree, "switching": rule, "step_s": step, **numbers})
    return pd.DataFrame(rows)


def six_part(
    slider: Mapping[str, Any], theta: float, duration: float, step: float, rule: str
) -> tuple[float, float]:
    """Events of Fig. 13 and mu_sapp of one run."""
    chain = Chain.from_slider(**{**slider, "theta": theta})
    run = march(run_rk4, (True,), chain, duration, step, "global slip", rule=rule).run
    found = apparent_friction(run, find_slips(run))
    return (found.events_counted, found.mu_sapp) if found else (np.nan, np.nan)


def six_of_readings(definitions: pd.DataFrame) -> pd.DataFrame:
    """The six numbers of every reading in definitions.csv, on a row each."""
    wide = definitions.assign(sign=np.sign(definitions["theta"])).pivot_table(
        index=READING, columns="sign", values=["events_counted", "mu_sapp"], dropna=False
    )
    return pd.DataFrame(wide.to_numpy(), columns=SIX).dropna()


def agree(found: pd.DataFrame, papers: ArrayLike) -> pd.DataFrame:
    """Which of the six numbers are the paper's: counts equal, mu_sapp to a unit of its last digit."""
    return (found[SIX] - np.asarray(papers)).abs() <= [0.0] * 3 + [WITHIN] * 3


def random_steps_table(
    draws: pd.DataFrame, definitions: pd.DataFrame, papers: Sequence[float]
) -> pd.DataFrame:
    """In how many draws each of the six numbers is the paper's, all six are, and any reading would agree.

    Parameters
    ----------
    draws, definitions : DataFrame
        What `draws_table` and `definitions_table` return.
    papers : sequence of float
        The six printed numbers, in the order of `SIX`.

    Returns
    -------
    DataFrame
        One row for each size of theta, rule of switching and question: n draws, k of them, share, and
        the ends low and high of its 95 % interval. "any reading" takes each draw for a paper, whose numbers
        are a matter of its step: has one of the readings in `definitions` all six of them?
    """
    return pd.DataFrame(
        {"degree": degree, "switching": rule, **row}
        for (degree, rule), own in draws.groupby(["degree", "switching"], sort=False)
        for row in _shares(own, six_of_readings(definitions), papers)
    )


def _shares(own: pd.DataFrame, readings: pd.DataFrame, papers: Sequence[float]) -> Iterator[dict[str, Any]]:
    right = agree(own, papers)
    printed = own.round(dict.fromkeys(SIX, DIGITS))[SIX]
    matched = [bool(agree(readings, mock).all(axis=1).any()) for mock in printed.to_numpy()]
    as_printed = (printed == papers).all(axis=1)
    questions: dict[str, ArrayLike] = {
        **{name: right[name] for name in SIX},
        "all six": right.all(axis=1),
        "all six as printed": as_printed,
        "any reading": matched,
    }
    for question, hits in questions.items():
        k, n = int(np.sum(np.asarray(hits))), len(own)
        low, high = share_interval(k, n)
        yield {"question": question, "n": n, "k": k, "share": k / n, "low": low, "high": high}
