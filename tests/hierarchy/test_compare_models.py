"""The comparison says what each model answers, how well, and which is the smallest that will do."""

from __future__ import annotations

from dataclasses import replace

import pytest
from golden.small_tables import SCENES, assert_kept, model_comparison

from precursors import Chain
from precursors.hierarchy.compare_models import DRAWS, SHORTEST, TOLERANCES, compare_models
from precursors.hierarchy.models import MODELS, Motion, move


def test_every_answer_is_the_one_that_is_kept() -> None:
    assert_kept("model_comparison", model_comparison())


def test_a_cost_is_that_of_a_warm_solution_repeated_until_it_can_be_measured(clock) -> None:
    calls, warm, rounds = [], 0.0005, 3
    motion = move(SCENES["even"])

    def prepare(chain: Chain) -> Motion:
        clock.now += warm if len(calls) > 1 + DRAWS else 10.0
        calls.append(chain)
        return motion

    models = {"chain": replace(MODELS["chain"], prepare=prepare)}
    table = compare_models({"even": SCENES["even"]}, TOLERANCES, models, rounds)
    assert table["cost_s"].tolist() == pytest.approx([warm] * len(TOLERANCES))
    # One run answers all questions, and each draw is run once.
    assert len(calls) == 1 + DRAWS + 2 + rounds * round(SHORTEST / warm)
