"""The ladder of models: what each rung answers, how far from the paper's chain, and at what cost."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import partial
from types import MappingProxyType
from typing import Any

import numpy as np
import pandas as pd

from precursors.hierarchy import MODELS, QUANTITIES, Model
from precursors.model.chain import Chain, FloatArray
from precursors.model.scene_models import (
    ADDED,
    EVENTS_KEPT,
    FIRST_LOAD,
    FRONT_LOADS,
    MU_SAPP,
    NO_ADDITION,
    PAPERS_MODEL,
    SLIP_DURATION,
    UNITS,
    WAVEFORM,
)
from precursors.support import timing

NO_ADDITIONS: Mapping[str, float] = MappingProxyType({})
WAVEFORM_SAMPLES = 2001

COLUMNS = [
    "scene",
    "question",
    "rung",
    "model",
    "label",
    "value",
    "unit",
    "error",
    "error_unit",
    "tolerance",
    "is_answer",
    "is_smallest",
    "cost_s",
    "addition",
]


@dataclass(frozen=True)
class Question:
    """A row of the ladder.

    Attributes
    ----------
    quantity : str
        Key of `QUANTITIES`.
    shown : callable
        One number that stands for the answer in the table.
    error : callable
        (answer, answer of the paper's chain, chain) -> distance between them.
    error_unit : str
        Unit of the error: "1" where it is relative, to the answer or to F_Z.
    """

    quantity: str
    shown: Callable[[Any], float]
    error: Callable[[Any, Any, Chain], float]
    error_unit: str


def relative(answer: float, exact: float, chain: Chain) -> float:
    """Error relative to the paper's chain."""
    return abs(answer - exact) / abs(exact)


def difference(answer: float, exact: float, chain: Chain) -> float:
    """Error as it stands."""
    return abs(answer - exact)


def loads_apart(answer: FloatArray, exact: FloatArray, chain: Chain) -> float:
    """Root mean square over the blocks of the error in the load that brings the front there, over F_Z."""
    return root_mean_square(answer - exact) / chain.normal_load


def waveforms_apart(answer: FloatArray, exact: FloatArray, chain: Chain) -> float:
    """Root mean square over time of the error in F_X, over F_Z, up to the end of the exact first global slip.

    An answer that ends earlier keeps its last load.
    """
    times = np.linspace(0.0, exact[-1, 0], WAVEFORM_SAMPLES)
    loads = [np.interp(times, wave[:, 0], wave[:, 1]) for wave in (answer, exact)]
    return root_mean_square(loads[0] - loads[1]) / chain.normal_load


def root_mean_square(values: FloatArray) -> float:
    """Root of the mean square."""
    return float(np.sqrt(np.mean(np.square(values))))


QUESTIONS = (
    Question(FIRST_LOAD, float, relative, "1"),
    Question(EVENTS_KEPT, float, difference, "events"),
    Question(MU_SAPP, float, relative, "1"),
    # The load at which the front reaches the middle stands for all.
    Question(FRONT_LOADS, lambda loads: float(loads[(len(loads) - 1) // 2]), loads_apart, "1"),
    Question(SLIP_DURATION, float, relative, "1"),
    # The largest load stands for the waveform.
    Question(WAVEFORM, lambda wave: float(wave[:, 1].max()), waveforms_apart, "1"),
)


def climb(
    chains: Mapping[str, Chain],
    tolerances: Mapping[str, float],
    models: Mapping[str, Model] = MODELS,
    rounds: int = timing.ROUNDS,
    additions: Mapping[str, float] = NO_ADDITIONS,
) -> pd.DataFrame:
    """Ask every model every question it answers, for the chains of some scenes.

    Parameters
    ----------
    chains : mapping
        Scene to chain.
    tolerances : mapping
        Largest error that counts as an answer, by quantity, in the unit of the question's error.
    models : mapping
        The rungs, from the smallest to the largest; the paper's chain among them.
    rounds : int
        How often each answer is timed: see `timing.measure`.
    additions : mapping
        What the models beyond the paper's chain add to it, in the units of `Chain.from_slider`: viscosity
        [N s/m], interface_stiffness of the whole interface [N/m], head_mass [kg]. A model whose addition has
        no value is left out.

    Returns
    -------
    DataFrame
        One row for each scene, question and model that answers it: rung (1, 2, ...), name and label of the
        model, value and its unit, error against the paper's chain, tolerance, is_answer (the error is within
        it), is_smallest (the first model that answers in every scene), cost_s (median time from the chain
        to the answer [s]), addition (what the model adds to the paper's chain, with value and unit). The
        error of a model with an addition is what the addition makes of the paper's chain.

    Raises
    ------
    ValueError
        If a question has no tolerance, or a model does not apply to one of the chains.
    """
    models = {name: model for name, model in models.items() if ADDED.get(name, "") in {"", *additions}}
    rows = []
    for question in QUESTIONS:
        if question.quantity not in tolerances:
            raise ValueError(f"no tolerance for {question.quantity!r}: needed is one for each question")
        tolerance = tolerances[question.quantity]
        exact = {scene: ask(models[PAPERS_MODEL], chain, question) for scene, chain in chains.items()}
        tasks = {
            (name, scene): partial(ask, model, extended(chain, model, additions), question)
            for name, model in models.items()
            if question.quantity in model.answers
            for scene, chain in chains.items()
        }
        answers = {key: timing.second_call(task) for key, task in tasks.items()}
        costs = timing.measure(tasks, rounds, seconds={key: seconds for key, (_, seconds) in answers.items()})
        rungs = {name: rung for rung, name in enumerate(models, 1)}
        found = [
            {
                "scene": scene,
                "question": question.quantity,
                "rung": rungs[name],
                "model": name,
                "label": models[name].label,
                "value": question.shown(answer),
                "unit": QUANTITIES[question.quantity].unit,
                "error": (error := question.error(answer, exact[scene], chains[scene])),
                "error_unit": question.error_unit,
                "tolerance": tolerance,
                "is_answer": error <= tolerance,
                "cost_s": costs[name, scene].seconds,
                "addition": _addition_text(name, additions),
            }
            for (name, scene), (answer, _) in answers.items()
        ]
        smallest = next(
            (name for name in models if _answers_everywhere([row for row in found if row["model"] == name])),
            None,
        )
        rows += [{**row, "is_smallest": row["model"] == smallest} for row in found]
    return pd.DataFrame(rows, columns=COLUMNS)


def extended(chain: Chain, model: Model, additions: Mapping[str, float]) -> Chain:
    """The chain with what the model adds to it; the interface's stiffness is shared equally by the blocks."""
    if model.name not in ADDED:
        return chain
    name, value = ADDED[model.name], additions[ADDED[model.name]]
    added: dict[str, Any] = {name: value / chain.n_blocks if name == "interface_stiffness" else value}
    return replace(chain, **added)


def ask(model: Model, chain: Chain, question: Question) -> Any:
    """Answer of a model to a question."""
    return model.answer(chain, [question.quantity])[question.quantity]


def _addition_text(model: str, additions: Mapping[str, float]) -> str:
    """What a model adds to the paper's chain, with its unit."""
    return f"{additions[ADDED[model]]:g} {UNITS[ADDED[model]]}" if model in ADDED else NO_ADDITION


def _answers_everywhere(rows: list[dict[str, Any]]) -> bool:
    return bool(rows) and all(row["is_answer"] for row in rows)
