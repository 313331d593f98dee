"""Compare the models: their answers, the errors against the paper's chain, and the
computing times."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np
import pandas as pd

from maegawa2010.studies.models.answers import MODELS, PAPERS_MODEL, UNITS, Model
from maegawa2010.support import timing
from maegawa2010.support.run_statistics import NOISE
from precursors.model.chain import Chain, FloatArray

# Runs with noise in the normal loads: seed, and number of runs.
SEED = 2014
DRAWS = 200
# Rounds of timing, and the least time of a model in each [s].
ROUNDS = 3
SHORTEST = 0.003


@dataclass(frozen=True)
class Question:
    """A question to all models.

    Attributes
    ----------
    tolerance
        A model answers the question if its error is at most this.
    error
        Function of an answer, the answer of the paper's chain, and the chain.
    error_unit
        Unit of the error and of the tolerance.
    shown
        One number that represents the answer in the table.
    quantiles
        If given, the answers are these quantiles over runs with noise in the normal
        loads, because a single run is one draw of many. The table has the last quantile,
        and the largest error of all quantiles.
    quantity
        The quantity of the models, if its name is not that of the question.
    """

    tolerance: float
    error: Callable[[Any, Any, Chain], Any]
    error_unit: str = "1"
    shown: Callable[[Any], float] = float
    quantiles: tuple[float, ...] = ()
    quantity: str = ""


def relative(answer: Any, exact: Any, chain: Chain) -> Any:
    """Error relative to the answer of the paper's chain."""
    return abs(answer - exact) / abs(exact)


def difference(answer: Any, exact: Any, chain: Chain) -> Any:
    """Absolute error."""
    return abs(answer - exact)


def load_error(answer: FloatArray, exact: FloatArray, chain: Chain) -> float:
    """Root mean square error of loads, over F_Z."""
    return float(np.sqrt(np.mean(np.square(answer - exact)))) / chain.normal_load


QUESTIONS = {
    "first_load": Question(1e-6, relative),  # rounding errors only
    # The paper's authors counted events by eye.
    "events_counted": Question(1, difference, "events", quantiles=(0.5,)),
    # Far below (mu_s - mu_k)/mu_k = 0.56, so that mu_k and mu_s do not pass as answers.
    "mu_sapp": Question(0.05, relative, quantiles=(0.5,)),
    "mu_sapp_band": Question(
        0.05, relative, quantiles=(0.05, 0.95), quantity="mu_sapp"
    ),
    "front_loads": Question(
        0.02,  # 8 N, less than the step from one of ten blocks to the next
        load_error,
        shown=lambda loads: float(loads[(len(loads) - 1) // 2]),  # at the middle
    ),
    # The experiment's duration is printed with one digit.
    "slip_duration": Question(0.1, relative),
}


def compare_models(
    sliders: Mapping[str, Mapping[str, Any]],
    models: Mapping[str, Model] = MODELS,
    rounds: int = ROUNDS,
) -> pd.DataFrame:
    """Compare the answers of all models to all questions, for the sliders of scenes.

    `models` are sorted from the smallest to the largest and include the paper's chain;
    `rounds` is how often each is timed.

    Returns
    -------
    DataFrame
        One row for each scene, question and model with the quantity of the question:
        value and unit (from runs with noise if the question has quantiles), error against
        the paper's chain, tolerance, is_answer (the error is within the tolerance),
        is_smallest (the smallest model that answers in every scene), and cost_s (median
        time in which the model gives all its answers [s]).
    """
    chains = {scene: Chain.from_slider(**slider) for scene, slider in sliders.items()}
    tasks = {
        (n, s): partial(model, chain)
        for n, model in models.items()
        for s, chain in chains.items()
    }
    answers = {key: ask() for key, ask in tasks.items()}
    noisy = {(n, s): noisy_answers(models[n], chains[s]) for n, s in tasks}
    costs = timing.measure(tasks, rounds, SHORTEST)
    rows = []
    for asked_for, question in QUESTIONS.items():
        quantity = question.quantity or asked_for
        asked = noisy if question.quantiles else answers
        for (name, scene), answered in asked.items():
            if quantity not in answered:
                continue
            exact = asked[PAPERS_MODEL, scene][quantity]
            value, error = value_and_error(
                question, answered[quantity], exact, chains[scene]
            )
            rows.append(
                {
                    "scene": scene,
                    "question": asked_for,
                    "model": name,
                    "value": value,
                    "unit": UNITS[quantity],
                    "error": error,
                    "error_unit": question.error_unit,
                    "tolerance": question.tolerance,
                    "is_answer": error <= question.tolerance,
                    "cost_s": costs[name, scene].seconds,
                }
            )
    return with_smallest(pd.DataFrame(rows))


def noisy_answers(model: Model, chain: Chain) -> dict[Any, Any]:
    """Answers for chains with noise in the normal loads, the same chains for all models."""
    random = np.random.default_rng(SEED)
    noises = NOISE * random.uniform(-1.0, 1.0, (DRAWS, chain.n_blocks))
    drawn = [
        model(replace(chain, weights=chain.weights * (1.0 + noise))) for noise in noises
    ]
    return pd.DataFrame(drawn).to_dict("series")


def value_and_error(
    question: Question, answer: Any, exact: Any, chain: Chain
) -> tuple[float, float]:
    """Value of an answer, and its error against the paper's chain; if the question has
    quantiles, both answers are samples."""
    if not question.quantiles:
        return question.shown(answer), question.error(answer, exact, chain)
    value, expected = (
        np.quantile(sample, question.quantiles) for sample in (answer, exact)
    )
    return value[-1], question.error(value, expected, chain).max()


def with_smallest(table: pd.DataFrame) -> pd.DataFrame:
    """Mark the smallest model that answers each question in every scene; models are
    sorted from the smallest."""
    answers = table.groupby(["question", "model"])["is_answer"].transform("all")
    smallest = table[answers].groupby("question")["model"].first()
    return table.assign(is_smallest=table["model"] == table["question"].map(smallest))
