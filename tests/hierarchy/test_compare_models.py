"""The comparison says what each model answers, how well, and which is the smallest that will do."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from golden import small_tables
from golden.small_tables import SCENES

from precursors import Chain
from precursors.figures import model_comparison, style
from precursors.hierarchy.compare_models import (
    DRAWS,
    SHORTEST,
    TOLERANCES,
    compare_models,
    waveform_error,
)
from precursors.hierarchy.models import MODELS, Motion, move
from precursors.support.files import read_table


@pytest.fixture(scope="module")
def comparison() -> pd.DataFrame:
    return small_tables.model_comparison()


def test_every_answer_is_the_one_that_is_kept(comparison: pd.DataFrame) -> None:
    small_tables.assert_kept("model_comparison", comparison)


def smallest(comparison: pd.DataFrame) -> dict[str, str]:
    found = comparison[comparison["is_smallest"]].drop_duplicates(["question", "model"])
    return dict(zip(found["question"], found["model"], strict=True))


def test_the_smallest_model_for_each_question_is_named(comparison: pd.DataFrame) -> None:
    assert smallest(comparison) == {
        "first_load": "statics",
        "events_counted": "quasistatic",
        "mu_sapp": "chain",
        "mu_sapp_band": "chain",
        "front_loads": "quasistatic",
        "slip_duration": "chain",
        "waveform": "chain",
    }


def test_the_papers_chain_has_no_error_and_every_answer_a_cost(comparison: pd.DataFrame) -> None:
    assert (comparison.loc[comparison["model"] == "chain", "error"] == 0).all()
    assert (comparison["cost_s"] > 0).all()


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


def test_waveforms_are_compared_over_the_same_time() -> None:
    exact = np.array([[0.0, 0.0], [2.0, 200.0], [2.0, 100.0], [4.0, 100.0]])
    short = np.array([[0.0, 0.0], [2.0, 200.0]])
    # Twice 100 N apart for half of the time.
    assert waveform_error(short, exact, SCENES["even"]) == pytest.approx(np.sqrt(0.5) * 100 / 400, rel=1e-3)


def test_the_figure_frames_the_smallest_models(comparison: pd.DataFrame, tmp_path) -> None:
    comparison.to_csv(tmp_path / "comparison.csv", index=False)
    figure = model_comparison.draw(read_table(tmp_path / "comparison.csv"))
    frames = [p for p in figure.axes[0].patches if not p.get_fill()]
    assert len(frames) == len(TOLERANCES)
    style.save(figure, tmp_path / "comparison.png")
    assert (tmp_path / "comparison.png").stat().st_size > 10_000
