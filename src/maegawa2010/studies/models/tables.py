"""Compare the models: what each answers, how far from the paper's chain, and at what
cost."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np
import pandas as pd

from maegawa2010.studies.models.models import MODELS, PAPERS_MODEL, UNITS, Model
from maegawa2010.support import timing
from maegawa2010.support.run_statistics import NOISE
from precursors.model.chain import Chain, FloatArray

# Of runs with noise in the normal loads: the seed, and how many runs.
SEED = 2014
DRAWS = 200
# how often a model is timed, and for how long at least [s]
ROUNDS = 3
SHORTEST = 0.003


@dataclass(frozen=True)
class Question:
    """One question to all models.

    `error` (answer, answer of the paper's chain, chain) is their distance, in units of
    `error_unit`; up to the `tolerance` it counts as an answer. `shown` is one number
    that stands for the answer in the table. `quantiles` are asked of runs with noise in
    the normal loads: one run of the chain at theta = 5/6 is a draw of many, and no
    measure of a model. The last one is shown, and the largest of their errors counts.
    `quantity` is that of the models, where it is not
    the name of the question.
    """

    tolerance: float
    error: Callable[[Any, Any, Chain], Any]
    error_unit: str = "1"
    shown: Callable[[Any], float] = float
    quantiles: tuple[float, ...] = ()
    quantity: str = ""


def relative(answer: Any, exact: Any, chain: Chain) -> Any:
    """Error relative to the paper's chain."""
    return abs(answer - exact) / abs(exact)


def difference(answer: Any, exact: Any, chain: Chain) -> Any:
    """Error as it stands."""
    return abs(answer - exact)


def load_error(answer: FloatArray, exact: FloatArray, chain: Chain) -> float:
    """Root mean square of the errors of some loads, over F_Z."""
    return float(np.sqrt(np.mean(np.square(answer - exact)))) / chain.normal_load


QUESTIONS = {
    "first_load": Question(1e-6, relative),  # a formula is right to rounding
    # The paper counts whole events by eye.
    "events_counted": Question(1, difference, "events", quantiles=(0.5,)),
    # A fifth of (mu_s - mu_k)/mu_k: it tells the models from mu_k and from mu_s.
    "mu_sapp": Question(0.05, relative, quantiles=(0.5,)),
    "mu_sapp_band": Question(
        0.05, relative, quantiles=(0.05, 0.95), quantity="mu_sapp"
    ),
    "front_loads": Question(
        0.02,  # 8 N, less than a step from one block to the next of ten
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
    """Ask every model every question it answers, for the sliders of some scenes.

    `models` go from the smallest to the largest, the paper's chain among them; `rounds`
    is how often each is timed.

    Returns
    -------
    DataFrame
        One row for each scene, question and model that answers it: value and its unit
        (of runs with noise where the question has quantiles), error against the paper's
        chain, tolerance, is_answer (the error is within it), is_smallest (the first
        model that answers in every scene), and cost_s (median time of all the model's
        answers [s]).
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
    """Answers about chains with noise in the normal loads, the same for all models."""
    random = np.random.default_rng(SEED)
    noises = NOISE * random.uniform(-1.0, 1.0, (DRAWS, chain.n_blocks))
    drawn = [
        model(replace(chain, weights=chain.weights * (1.0 + noise))) for noise in noises
    ]
    return pd.DataFrame(drawn).to_dict("series")


def value_and_error(
    question: Question, answer: Any, exact: Any, chain: Chain
) -> tuple[float, float]:
    """Value of an answer, and its error against that of the paper's chain; where the
    question has quantiles, both are samples of runs."""
    if not question.quantiles:
        return question.shown(answer), question.error(answer, exact, chain)
    value, expected = (
        np.quantile(sample, question.quantiles) for sample in (answer, exact)
    )
    return value[-1], question.error(value, expected, chain).max()


def with_smallest(table: pd.DataFrame) -> pd.DataFrame:
    """Mark for each question the smallest model that answers it in every scene; models
    are in order."""
    answers = table.groupby(["question", "model"])["is_answer"].transform("all")
    smallest = table[answers].groupby("question")["model"].first()
    return table.assign(is_smallest=table["model"] == table["question"].map(smallest))
