"""Compare the models: what each answers, how far from the paper's chain, and at what cost."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np
import pandas as pd

from precursors.analysis.run_statistics import median_interval
from precursors.hierarchy.models import MODELS, UNITS, Model
from precursors.model.chain import Chain, FloatArray
from precursors.model.scenes import PAPERS_MODEL
from precursors.support import timing

WAVEFORM_SAMPLES = 2001
# Of runs with noise in the normal loads: its relative size, well below what an experiment knows of them; the
# seed; and how many runs.
NOISE, SEED, DRAWS = 1e-3, 2014, 80


@dataclass(frozen=True)
class Question:
    """One question to all models.

    Attributes
    ----------
    shown : callable
        One number that stands for the answer in the table.
    error : callable
        (answer, answer of the paper's chain, chain) -> distance between them.
    error_unit : str
        Unit of the error: "1" where it is relative, to the answer or to F_Z.
    noisy : bool
        Whether the answer is the median of runs with noise in the normal loads. One run of the chain at
        theta = 5/6 is a draw of many, and no measure of a model.
    """

    shown: Callable[[Any], float]
    error: Callable[[Any, Any, Chain], float]
    error_unit: str = "1"
    noisy: bool = False


def relative(answer: float, exact: float, chain: Chain) -> float:
    """Error relative to the paper's chain."""
    return abs(answer - exact) / abs(exact)


def difference(answer: float, exact: float, chain: Chain) -> float:
    """Error as it stands."""
    return abs(answer - exact)


def front_error(answer: FloatArray, exact: FloatArray, chain: Chain) -> float:
    """Root mean square over the blocks of the error in the load that brings the front there, over F_Z."""
    return root_mean_square(answer - exact) / chain.normal_load


def waveform_error(answer: FloatArray, exact: FloatArray, chain: Chain) -> float:
    """Root mean square over time of the error in F_X, over F_Z, up to the end of the exact first global slip.

    An answer that ends earlier keeps its last load.
    """
    times = np.linspace(0.0, exact[-1, 0], WAVEFORM_SAMPLES)
    loads = [np.interp(times, wave[:, 0], wave[:, 1]) for wave in (answer, exact)]
    return root_mean_square(loads[0] - loads[1]) / chain.normal_load


def root_mean_square(values: FloatArray) -> float:
    """Root of the mean square."""
    return float(np.sqrt(np.mean(np.square(values))))


QUESTIONS = {
    "first_load": Question(float, relative),
    "events_counted": Question(float, difference, "events", noisy=True),
    "mu_sapp": Question(float, relative, noisy=True),
    # The load at which the front reaches the middle stands for all.
    "front_loads": Question(lambda loads: float(loads[(len(loads) - 1) // 2]), front_error),
    "slip_duration": Question(float, relative),
    # The largest load stands for the waveform.
    "waveform": Question(lambda wave: float(wave[:, 1].max()), waveform_error),
}


def compare_models(
    chains: Mapping[str, Chain],
    tolerances: Mapping[str, float],
    models: Mapping[str, Model] = MODELS,
    rounds: int = timing.ROUNDS,
) -> pd.DataFrame:
    """Ask every model every question it answers, for the chains of some scenes.

    Parameters
    ----------
    chains : mapping
        Scene to chain.
    tolerances : mapping
        Largest error that counts as an answer, for each of `QUESTIONS`, in the unit of the question's error.
    models : mapping
        The models, from the smallest to the largest; the paper's chain is among them.
    rounds : int
        How often each answer is timed: see `timing.measure`.

    Returns
    -------
    DataFrame
        One row for each scene, question and model that answers it: model_number (1, 2, ...), name and label
        of the model, value and its unit (of events_counted and mu_sapp the median of runs with noise in the
        normal loads), error against the paper's chain, tolerance, is_answer (the error is
        within it), is_smallest (the first model that answers in every scene), cost_s (median time from the
        chain to the answer [s]).
    """
    rows = []
    noisy = {
        (name, scene): noisy_answers(model, chain)
        for name, model in models.items()
        for scene, chain in chains.items()
    }
    for quantity, question in QUESTIONS.items():
        tasks = {
            (name, scene): partial(model.ask, chain, quantity)
            for name, model in models.items()
            if quantity in model.answers
            for scene, chain in chains.items()
        }
        answers = {key: timing.second_call(task) for key, task in tasks.items()}
        costs = timing.measure(tasks, rounds, seconds={key: seconds for key, (_, seconds) in answers.items()})
        given = {key: answer for key, (answer, _) in answers.items()}
        exact = {scene: given[PAPERS_MODEL, scene] for scene in chains}
        if question.noisy:
            given = {key: float(np.nanmedian(noisy[key][quantity])) for key in tasks}
            known = {scene: median_interval(noisy[PAPERS_MODEL, scene][quantity]) for scene in chains}
        for (name, scene), answer in given.items():
            # The chain's median is known to its interval only: its nearest value to the answer.
            nearest = np.clip(answer, *known[scene]) if question.noisy else exact[scene]
            error = question.error(answer, nearest, chains[scene])
            rows.append(
                {
                    "scene": scene,
                    "question": quantity,
                    "model_number": list(models).index(name) + 1,
                    "model": name,
                    "label": models[name].label,
                    "value": question.shown(answer),
                    "unit": UNITS[quantity],
                    "error": error,
                    "error_unit": question.error_unit,
                    "tolerance": tolerances[quantity],
                    "is_answer": error <= tolerances[quantity],
                    "cost_s": costs[name, scene].seconds,
                }
            )
    return with_smallest(pd.DataFrame(rows))


def noisy_answers(model: Model, chain: Chain) -> dict[str, list[float]]:
    """Answers to the noisy questions for chains with noise in the normal loads, the same for all models."""
    random = np.random.default_rng(SEED)
    noises = NOISE * random.uniform(-1.0, 1.0, (DRAWS, chain.n_blocks))
    asked = [quantity for quantity in model.answers if quantity in QUESTIONS and QUESTIONS[quantity].noisy]
    found: dict[str, list[float]] = {quantity: [] for quantity in asked}
    for noise in noises if asked else ():
        prepared = model.prepare(replace(chain, weights=chain.weights * (1.0 + noise)))
        for quantity in asked:
            found[quantity].append(model.answers[quantity](prepared))
    return found


def with_smallest(table: pd.DataFrame) -> pd.DataFrame:
    """Mark for each question the smallest model that answers it in every scene."""
    answers = table.groupby(["question", "model_number"])["is_answer"].all()
    smallest = answers[answers].reset_index().groupby("question")["model_number"].min()
    return table.assign(is_smallest=table["model_number"] == table["question"].map(smallest))
