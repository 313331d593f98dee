"""What maps cost follows from the times that were measured, and the times are of the runs that they name."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import yaml

from precursors.ensembles.maps import map_study
from precursors.ensembles.scaling import (
    LONGEST_CHUNK,
    SHORTEST_CHUNK,
    STARTS,
    even_sample,
    growth_exponent,
    measure_costs,
    members_of,
    time_of_maps,
)
from precursors.ensembles.scaling_text import in_words
from precursors.model.chain import Chain
from precursors.model.scenes import scene_slider
from precursors.solver.simulate import simulate

CONFIG = yaml.safe_load((Path(__file__).parents[2] / "config.yaml").read_text(encoding="utf-8"))
SMALL = {"n_blocks": [2, 3], "seconds_per_point": 1e-4, "durations": [0.1, 3.0]}
SMALL |= {"points": 100, "sample": 9, "repetitions": 1}
MOMENT = 60.0  # s, that no measurement of these few runs reaches
# An even sample has the mean of the map to a small part of the map's width, which its edges alone have not.
SHARE_OF_WIDTH = 0.01


@pytest.fixture(scope="module")
def costs():
    return measure_costs({**CONFIG, "scaling": {**CONFIG["scaling"], **SMALL}})


def test_everything_is_timed_once(costs):
    assert not costs.duplicated(["kind", "case"]).any()
    assert costs["kind"].value_counts().to_dict() == {
        "first slip": 2,
        "duration": 2 * len(CONFIG["fig13"]),
        "map": 4,
        "start": len(STARTS),
    }
    assert costs["seconds_per_run"].between(0, MOMENT, inclusive="neither").all()


def test_the_transitions_counted_are_those_of_the_runs_timed(costs):
    for row in costs[costs["kind"] == "duration"].itertuples():
        chain = Chain.from_slider(**scene_slider(CONFIG, row.case.split(",")[0]))
        assert row.transitions_per_run == len(simulate(chain, row.duration_s).transitions)
    moved = costs[costs["transitions_per_run"] > 0]
    assert set(moved["kind"]) == {"first slip", "duration"}
    assert np.allclose(
        moved["seconds_per_transition"] * moved["transitions_per_run"], moved["seconds_per_run"]
    )


def test_a_process_that_does_more_takes_longer(costs):
    starts = costs[costs["kind"] == "start"]["seconds_per_run"]
    assert starts.is_monotonic_increasing


@pytest.mark.parametrize("name", ["map_blocks", "map_friction"])
def test_the_sample_is_spread_evenly_over_the_map(name):
    study = map_study({**CONFIG, "maps": {**CONFIG["maps"], "points": 90_000}}, name)
    axis = {"map_blocks": "n_blocks", "map_friction": "friction_ratio"}[name]
    sample = members_of(study, even_sample(study.column(axis), 900))
    assert len(sample) == pytest.approx(900, rel=0.1)
    for column in (axis, "theta"):
        whole, part = study.column(column), sample.column(column)
        assert abs(part.mean() - whole.mean()) < SHARE_OF_WIDTH * np.ptp(whole)
        assert part.std() == pytest.approx(whole.std(), rel=SHARE_OF_WIDTH)


def test_one_core_takes_all_runs_and_all_jobs_one_after_another():
    [row] = time_of_maps({"map": 1e-3}, 1_000_000, [1], 10.0).query("map == 'map'").to_dict("records")
    assert row["core_hours"] == pytest.approx(1000.0 / 3600.0)
    assert row["wall_hours"] == pytest.approx((1000.0 + 10.0 * row["chunks"]) / 3600.0)


def test_more_cores_are_never_slower_nor_faster_than_their_number():
    table = time_of_maps({"short": 1e-5, "long": 0.1}, 1_000_000, [1, 4, 16, 64, 256, 1024], 10.0)
    for _, rows in table.groupby("map"):
        assert rows["wall_hours"].is_monotonic_decreasing
        assert (rows["wall_hours"] * rows["cores"] >= rows["core_hours"]).all()


def test_chunks_are_worth_a_job_and_not_too_long_to_lose():
    table = time_of_maps({"long": 0.1}, 1_000_000, [1, 16, 256, 100_000], 10.0)
    assert table["seconds_per_chunk"].between(0.9 * SHORTEST_CHUNK, LONGEST_CHUNK).all()


def test_all_maps_together_cost_their_sum():
    table = time_of_maps({"a": 1e-3, "b": 2e-3}, 1000, [1], 0.0).set_index("map")["core_hours"]
    assert table["all of them"] == pytest.approx(table["a"] + table["b"])


def test_a_power_law_has_its_exponent():
    n = np.array([20.0, 50.0, 100.0, 200.0])
    assert growth_exponent(n, 3e-6 * n**2.5) == pytest.approx(2.5)


@pytest.mark.parametrize(
    ("seconds", "words"),
    [(3.14159e-4, "310 us"), (1.2e-3, "1.2 ms"), (70.2, "70 s"), (150.0, "2.5 min"), (13061.0, "3.6 h")],
)
def test_times_have_two_digits_and_a_unit(seconds, words):
    assert in_words(seconds) == words
