"""Compare the models: what each answers, how far from the paper's chain, and at what
cost."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np
import pandas as pd

from precursors.analysis.run_statistics import NOISE
from precursors.hierarchy.models import MODELS, PAPERS_MODEL, UNITS, Model
from precursors.model.chain import Chain, FloatArray
from precursors.support import timing

WAVEFORM_SAMPLES = 2001
# Of runs with noise in the normal loads: the seed; how many runs; and how often they
# are drawn again for the interval of an error (bootstrap).
SEED = 2014
DRAWS = 200
RESAMPLES = 500
# how often a model is timed, and for how long at least [s]
ROUNDS = 3
SHORTEST = 0.003


@dataclass(frozen=True)
class Question:
    """One question to all models.

    `error` (answer, answer of the paper's chain, chain) is their distance, in units of
    `error_unit`; up to the `tolerance`, with its whole 95 % interval, it counts as an
    answer. `shown` is one number that stands for the answer in the table. A `statistic`
    (values, axis) is asked of runs with noise in the normal loads: one run of the chain
    at theta = 5/6 is a draw of many, and no measure of a model. `quantity` is that of
    the models, where it is not the name of the question.
    """

    tolerance: float
    error: Callable[[Any, Any, Chain], Any]
    error_unit: str = "1"
    shown: Callable[[Any], float] = float
    statistic: Callable[[FloatArray, int], FloatArray] | None = None
    quantity: str = ""


def relative(answer: Any, exact: Any, chain: Chain) -> Any:
    """Error relative to the paper's chain."""
    return abs(answer - exact) / abs(exact)


def difference(answer: Any, exact: Any, chain: Chain) -> Any:
    """Error as it stands."""
    return abs(answer - exact)


def ends_of_band(values: FloatArray, axis: int) -> FloatArray:
    """5 and 95 % of the runs."""
    return np.asarray(np.quantile(values, [0.05, 0.95], axis=axis))


def ends_error(answer: FloatArray, exact: FloatArray, chain: Chain) -> Any:
    """Larger of the relative errors of both ends."""
    return relative(answer, exact, chain).max(axis=0)


def front_error(answer: FloatArray, exact: FloatArray, chain: Chain) -> float:
    """Root mean square over the blocks of the error in the load that brings the front
    there, over F_Z."""
    return root_mean_square(answer - exact) / chain.normal_load


def waveform_error(answer: FloatArray, exact: FloatArray, chain: Chain) -> float:
    """Root mean square over time of the error in F_X, over F_Z, up to the end of the
    exact first global slip.

    An answer that ends earlier keeps its last load.
    """
    times = np.linspace(0.0, exact[-1, 0], WAVEFORM_SAMPLES)
    loads = [np.interp(times, wave[:, 0], wave[:, 1]) for wave in (answer, exact)]
    return root_mean_square(loads[0] - loads[1]) / chain.normal_load


def root_mean_square(values: FloatArray) -> float:
    """Root of the mean square."""
    return float(np.sqrt(np.mean(np.square(values))))


QUESTIONS = {
    "first_load": Question(1e-6, relative),  # a formula is right to rounding
    # The paper counts whole events by eye.
    "events_counted": Question(1, difference, "events", statistic=np.median),
    # A fifth of (mu_s - mu_k)/mu_k: it tells the models from mu_k and from mu_s.
    "mu_sapp": Question(0.05, relative, statistic=np.median),
    "mu_sapp_band": Question(
        0.05,
        ends_error,
        shown=lambda ends: float(ends[1]),  # the upper end stands for both
        statistic=ends_of_band,
        quantity="mu_sapp",
    ),
    "front_loads": Question(
        0.02,  # 8 N, less than a step from one block to the next of ten
        front_error,
        shown=lambda loads: float(loads[(len(loads) - 1) // 2]),  # at the middle
    ),
    # The experiment's duration is printed with one digit.
    "slip_duration": Question(0.1, relative),
    "waveform": Question(
        0.02,  # as front_loads
        waveform_error,
        shown=lambda wave: float(wave[:, 1].max()),
    ),
}


def model_comparison(sliders: Mapping[str, Mapping[str, Any]]) -> pd.DataFrame:
    """`compare_models` for the sliders of some scenes."""
    chains = {scene: Chain.from_slider(**slider) for scene, slider in sliders.items()}
    return compare_models(chains)


def compare_models(
    chains: Mapping[str, Chain],
    models: Mapping[str, Model] = MODELS,
    rounds: int = ROUNDS,
) -> pd.DataFrame:
    """Ask every model every question it answers, for the chains of some scenes.

    `models` go from the smallest to the largest, the paper's chain among them; `rounds`
    is how often each is timed.

    Returns
    -------
    DataFrame
        One row for each scene, question and model that answers it: model_number (1, 2,
        ...) and name of the model, value and its unit (a statistic of runs with noise
        where the question has one), error against the paper's chain with its 95 %
        interval (error_low, error_high, which are the error where there is no noise),
        tolerance, is_answer (the whole interval is within it), is_smallest (the first
        model that answers in every scene), and cost_s (median time of all the model's
        answers [s]).
    """
    rows = []
    tasks = {
        (n, s): partial(model, chain)
        for n, model in models.items()
        for s, chain in chains.items()
    }
    answers = {key: ask() for key, ask in tasks.items()}
    noisy = {(n, s): noisy_answers(models[n], chains[s]) for n, s in tasks}
    costs = timing.measure(tasks, rounds, SHORTEST)
    for asked_for, question in QUESTIONS.items():
        quantity = question.quantity or asked_for
        asked = noisy if question.statistic else answers
        for (name, scene), answered in asked.items():
            if quantity not in answered:
                continue
            exact = asked[PAPERS_MODEL, scene][quantity]
            answer, error, low, high = answer_and_error(
                question, answered[quantity], exact, chains[scene]
            )
            rows.append(
                {
                    "scene": scene,
                    "question": asked_for,
                    "model_number": list(models).index(name) + 1,
                    "model": name,
                    "value": question.shown(answer),
                    "unit": UNITS[quantity],
                    "error": error,
                    "error_low": low,
                    "error_high": high,
                    "error_unit": question.error_unit,
                    "tolerance": question.tolerance,
                    "is_answer": high <= question.tolerance,
                    "cost_s": costs[name, scene].seconds,
                }
            )
    return with_smallest(pd.DataFrame(rows))


def noisy_answers(model: Model, chain: Chain) -> dict[str, FloatArray]:
    """Answers to the questions that have a statistic for chains with noise in the
    normal loads, the same for all models."""
    random = np.random.default_rng(SEED)
    noises = NOISE * random.uniform(-1.0, 1.0, (DRAWS, chain.n_blocks))
    drawn = [
        model(replace(chain, weights=chain.weights * (1.0 + noise))) for noise in noises
    ]
    return {
        name: np.array([answers[name] for answers in drawn])
        for name, question in QUESTIONS.items()
        if question.statistic and name in drawn[0]
    }


def answer_and_error(
    question: Question, answer: Any, exact: Any, chain: Chain
) -> tuple[Any, float, float, float]:
    """Answer of a model, and its error against that of the paper's chain with a 95 %
    interval.

    Where the question has a statistic, both are samples of runs, which are drawn again
    and again. The chain has no error against itself.
    """
    if not question.statistic:
        error = question.error(answer, exact, chain)
        return answer, error, error, error
    value = question.statistic(answer, 0)
    if answer is exact:
        return value, 0.0, 0.0, 0.0
    random = np.random.default_rng(SEED)
    drawn, drawn_exact = (
        question.statistic(random.choice(sample, (len(sample), RESAMPLES)), 0)
        for sample in (answer, exact)
    )
    low, high = np.quantile(question.error(drawn, drawn_exact, chain), [0.025, 0.975])
    error = question.error(value, question.statistic(exact, 0), chain)
    return value, float(error), float(low), float(high)


def with_smallest(table: pd.DataFrame) -> pd.DataFrame:
    """Mark for each question the smallest model that answers it in every scene."""
    answers = table.groupby(["question", "model_number"])["is_answer"].all()
    smallest = answers[answers].reset_index().groupby("question")["model_number"].min()
    return table.assign(
        is_smallest=table["model_number"] == table["question"].map(smallest)
    )
