"""A study gives the same however it is cut, keeps its files honest, and is judged by the stated rule."""

from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import yaml

from precursors import Chain, simulate
from precursors.analysis.summary import summarise
from precursors.ensembles import chunks, long_runs, resolution, spread
from precursors.ensembles.catalogue import chunk_names, make_study
from precursors.ensembles.study import Study, run_members

CONFIG = yaml.safe_load((Path(__file__).parents[2] / "config.yaml").read_text(encoding="utf-8"))
SMALL = {
    "seed": 1,
    "members": 3,
    "loads": [1e-12, 1e-2],
    "start": [1e-2],
    "parameters": [1e-2],
    "theta": {"window": 0.0034, "points": 3},
}


def with_ensembles(**sections):
    """The paper's configuration with other values in sections of `ensembles`."""
    ensembles = CONFIG["ensembles"]
    changed = {name: {**ensembles[name], **values} for name, values in sections.items()}
    return {**CONFIG, "ensembles": {**ensembles, **changed}}


FEW = with_ensembles(spread=SMALL)


@pytest.fixture(scope="module")
def study() -> Study:
    return make_study(FEW, "spread_members")


@pytest.fixture(scope="module")
def results(study):
    return run_members(study, 0, len(study))


@pytest.fixture
def table(study, results, tmp_path):
    chunks.save_chunk(tmp_path / "all.h5", study, 0, results)
    return chunks.gather(study, [tmp_path / "all.h5"])


def bytes_of(results):
    return [results[name].tobytes() for name in results.dtype.names]


def rows(study, **labels):
    return np.flatnonzero(np.all([study.columns[name] == value for name, value in labels.items()], axis=0))


@pytest.mark.parametrize("cuts", [(1,), (7, 40, 41)])
def test_results_are_the_same_to_the_last_bit_however_a_study_is_cut(study, results, cuts):
    bounds = [0, *cuts, len(study)]
    parts = [run_members(study, a, b) for a, b in pairwise(bounds)]
    assert bytes_of(np.concatenate(parts)) == bytes_of(results)


def test_results_are_the_same_to_the_last_bit_on_two_threads(study, results):
    assert bytes_of(run_members(study, 0, len(study), threads=2)) == bytes_of(results)


def test_chunks_cover_every_member_once_and_are_worth_the_same_time(study):
    seconds = chunks.estimated_seconds(study)
    plan = chunks.plan_chunks(study, seconds.sum() / 3.5)
    assert len(plan) == 4
    assert [i for first, end in plan for i in range(first, end)] == list(range(len(study)))
    worth = [seconds[first:end].sum() for first, end in plan]
    assert max(worth) - min(worth) <= 2 * seconds.max()
    assert chunks.plan_chunks(study, 1e9) == [(0, len(study))]
    assert 0.9 * len(study) < len(chunks.plan_chunks(study, 1e-9)) <= len(study)


def test_long_chains_and_long_runs_are_expected_to_take_longer():
    slider = {**CONFIG["chain"], "theta": 0.0}
    blocks = {"n_blocks": np.array([2, 10, 200])}
    to_first_slip = chunks.estimated_seconds(Study("one", slider, blocks))
    for_ten_seconds = chunks.estimated_seconds(Study("one", slider, blocks, until=None))
    assert (np.diff(to_first_slip) > 0).all()
    assert (for_ten_seconds > to_first_slip).all()


def test_chains_on_interface_springs_are_expected_to_take_longer_and_longest_without_viscosity():
    slider = {**CONFIG["chain"], "theta": 0.0, "n_blocks": 10}
    added = {
        "interface_stiffness": np.array([0.0, 25e6, 25e6]),
        "viscosity": np.array([54.77, 54.77, 0.0]),
    }
    for until in ("global slip", None):
        viscous, damped, ringing = chunks.estimated_seconds(Study("one", slider, added, until=until))
        assert 2 * viscous < damped < 0.5 * ringing
    plain = chunks.estimated_seconds(Study("one", slider, {"viscosity": np.array([0.0, 54.77])}))
    assert plain[0] == plain[1]


def test_a_chunk_file_gives_back_its_results_with_units(study, results, tmp_path):
    chunks.save_chunk(tmp_path / "c.h5", study, 5, results[5:9])
    first, columns = chunks.load_chunk(tmp_path / "c.h5", study)
    assert first == 5
    assert {"time_s", "end_s", "crossing_time_s", "load_N", "mu_sapp", "reached"} < columns.keys()
    np.testing.assert_array_equal(columns["load_N"], results["load"][5:9])


@pytest.mark.parametrize("place", [3, 100, -3])
def test_a_chunk_file_with_one_changed_byte_is_refused(study, results, tmp_path, place):
    path = tmp_path / "c.h5"
    chunks.save_chunk(path, study, 0, results)
    content = bytearray(path.read_bytes())
    content[place] ^= 1
    path.write_bytes(content)
    with pytest.raises(ValueError, match=r"c\.h5"):
        chunks.load_chunk(path, study)


@pytest.mark.parametrize(
    "change",
    [
        lambda study: {"seed": 2},
        lambda study: {"until": None},
        lambda study: {"duration": 9.0},
        lambda study: {"slider": {**study.slider, "length": 0.2}},
        lambda study: {"columns": {**study.columns, "mu_s": study.columns["mu_s"] * 1.0000001}},
    ],
)
def test_a_chunk_of_a_study_with_other_members_is_refused(study, results, tmp_path, change):
    chunks.save_chunk(tmp_path / "c.h5", study, 0, results)
    with pytest.raises(ValueError, match="as it is now"):
        chunks.load_chunk(tmp_path / "c.h5", replace(study, **change(study)))


def test_a_missing_and_a_doubled_chunk_are_noticed(study, results, tmp_path):
    half = len(study) // 2
    chunks.save_chunk(tmp_path / "a.h5", study, 0, results[:half])
    chunks.save_chunk(tmp_path / "b.h5", study, half, results[half:])
    assert len(chunks.gather(study, [tmp_path / "b.h5", tmp_path / "a.h5"])) == len(study)
    for paths in (["a.h5"], ["a.h5", "a.h5"], ["a.h5", "b.h5", "b.h5"]):
        with pytest.raises(ValueError, match="each once"):
            chunks.gather(study, [tmp_path / name for name in paths])


def test_a_larger_ensemble_contains_the_smaller(study):
    larger = make_study(with_ensembles(spread={**SMALL, "members": 5}), "spread_members")
    for labels in ({"question": "loads", "size": 1e-2}, {"perturbation": "mu_s", "size": 1e-2}):
        few, many = rows(study, scene="fig10", **labels), rows(larger, scene="fig10", **labels)
        for i, j in zip(few, many[:3], strict=True):
            (a, start_a), (b, start_b) = study.member(i), larger.member(j)
            assert a == b
            assert (start_a is None) == (start_b is None)


def test_members_are_the_chains_that_their_labels_say(study):
    for scene, theta in (("fig11", -5 / 6), ("fig10", 0.0), ("fig12", 5 / 6)):
        plain = Chain.from_slider(theta=theta)
        [alone] = rows(study, scene=scene, question="start", perturbation="none")
        assert study.member(alone)[0] == plain
        for i in rows(study, scene=scene, perturbation="normal loads", size=1e-2):
            change = study.member(i)[0].weights / plain.weights - 1
            assert 0 < np.abs(change).max() <= 1e-2
            assert len(set(change)) == plain.n_blocks
        for i in rows(study, scene=scene, perturbation="k"):
            chain = study.member(i)[0]
            assert 0 < abs(chain.stiffness / plain.stiffness - 1) <= 1e-2
            assert np.array_equal(chain.weights, plain.weights)
        for i in rows(study, scene=scene, perturbation="initial positions"):
            chain, start = study.member(i)
            assert chain == plain
            assert 0 < np.abs(start).max() <= 1e-2 * 0.7 * 400 / 10 / 25e6 * (1 + 1e-12)
    draws = [study.member(i)[0].weights.tobytes() for i in rows(study, perturbation="normal loads")]
    assert len(set(draws)) == len(draws)


def test_the_members_of_a_study_are_run_with_their_own_start_and_duration():
    columns = {
        "start_noise": np.array([0.0, 0.5, 0.5]),
        "duration": np.array([1.0, 1.0, 2.0]),
        "group": np.zeros(3, int),
        "draw": np.zeros(3, int),
    }
    study = Study("own", {"theta": 0.0, "n_blocks": 4}, columns, until=None)
    alone = []
    for i, duration in enumerate((1.0, 1.0, 2.0)):
        chain, start = study.member(i)
        alone.append(simulate(chain, duration, start_positions=start))
    assert bytes_of(run_members(study, 0, 3)) == bytes_of(summarise(alone))


def test_noise_without_numbers_for_its_random_stream_is_refused():
    with pytest.raises(ValueError, match="group and draw"):
        Study("noisy", {}, {"load_noise": np.array([0.1])})


def test_the_spread_tells_unchanged_members_from_changed_ones(table):
    found = spread.spread_table(table).set_index(["scene", "perturbation", "size", "quantity"]).sort_index()
    tiny = found.loc[("fig10", "normal loads", 1e-12)]
    assert (tiny["share_unchanged"] == 1.0).all()
    assert tiny.loc["mu_sapp", "q50"] == pytest.approx(0.48576, abs=1e-5)
    assert found.loc[("fig12", "normal loads", 1e-2, "mu_sapp"), "share_unchanged"] < 1.0
    assert found.loc[("fig12", "normal loads", 1e-2, "mu_sapp"), "largest"] > 0.5
    assert set(found["n"]) == {3}


def members_with(changes: dict[float, list[float]]) -> pd.DataFrame:
    """Members of one scene whose mu_sapp is as given for each size, all else unchanged."""
    alone = {"scene": "s", "question": "loads", "perturbation": "none", "size": 0.0, "mu_sapp": 0.5}
    rest = {"events_kept": 4, "n_events": 5, "time_s": 2.0, "reached": True}
    changed = [
        {**alone, **rest, "perturbation": "noise", "size": size, "mu_sapp": mu}
        for size, values in changes.items()
        for mu in values
    ]
    return pd.DataFrame([{**alone, **rest}, *changed])


@pytest.mark.parametrize(
    ("changes", "expected"),
    [
        ({1e-4: [0.5] * 20, 1e-2: [0.504] * 20}, "robust"),
        ({1e-4: [0.5] * 20, 1e-2: [0.5] * 19 + [0.6]}, "robust"),
        ({1e-4: [0.5] * 20, 1e-2: [0.5] * 18 + [0.6] * 2}, "sensitive"),
        ({1e-4: [0.5] * 20, 1e-2: [0.506] * 20}, "sensitive"),
        ({1e-4: [0.5] * 18 + [0.4] * 2, 1e-2: [0.5] * 20}, "fragile"),
        ({1e-4: [np.nan] * 20, 1e-2: [0.6] * 20}, "fragile"),
    ],
)
def test_a_number_is_classed_by_the_smallest_change_that_it_does_not_survive(changes, expected):
    judged = spread.robustness_table(spread.spread_table(members_with(changes))).set_index("quantity")
    assert judged.loc["mu_sapp", "class"] == expected
    assert judged.loc["mu_sapp", "rule"] == spread.RULES[expected]
    assert judged.loc["events_kept", "class"] == "robust"


def test_the_scene_with_the_load_at_the_leading_edge_is_fragile():
    config = with_ensembles(spread={**SMALL, "members": 20, "loads": [1e-4], "parameters": [1e-5]})
    study = make_study(config, "spread_members")
    wanted = [i for i in range(len(study)) if study.columns["scene"][i] in ("fig10", "fig12")]
    wanted = [i for i in wanted if study.columns["perturbation"][i] in ("none", "normal loads", "theta")]
    found = summarise([simulate(study.member(i)[0], until="global slip") for i in wanted])
    members = pd.DataFrame({name: values[wanted] for name, values in study.columns.items()})
    members = pd.concat([members, pd.DataFrame(found).rename(columns={"time": "time_s"})], axis=1)
    judged = spread.robustness_table(spread.spread_table(members)).set_index(["scene", "quantity"])
    assert judged.loc[("fig12", "mu_sapp"), "class"] == "fragile"
    assert judged.loc[("fig10", "events_kept"), "class"] != "fragile"


def test_an_unknown_study_is_refused_by_name():
    with pytest.raises(ValueError, match="'wave' is unknown: allowed are spread_members"):
        make_study(FEW, "wave")


def test_chunks_are_named_after_their_members(study):
    config = {**FEW, "ensembles": {**FEW["ensembles"], "seconds_per_chunk": 1e9}}
    assert chunk_names(config, "spread_members") == [f"0-{len(study) - 1}"]


@pytest.mark.parametrize(
    ("name", "axis", "attribute"),
    [
        ("map_blocks", "n_blocks", lambda chain: chain.n_blocks),
        ("map_friction", "friction_ratio", lambda chain: chain.mu_k / chain.mu_s),
        ("map_stiffness", "stiffness_ratio", lambda chain: chain.drive_stiffness / chain.stiffness),
        ("map_velocity", "drive_velocity", lambda chain: chain.drive_velocity),
    ],
)
def test_the_chains_of_a_map_are_what_its_axes_say(name, axis, attribute):
    config = with_ensembles(maps={"points": 36})
    study = make_study(config, name)
    grid = {(study.columns[axis][i], study.columns["theta"][i]) for i in range(len(study))}
    assert len(grid) == len(study) == 36
    assert study.columns[axis].min() == pytest.approx(CONFIG["ensembles"]["maps"][axis][0])
    assert study.columns[axis].max() == pytest.approx(CONFIG["ensembles"]["maps"][axis][1])
    for i in (0, 17, 35):
        chain, start = study.member(i)
        assert start is None
        assert attribute(chain) == pytest.approx(study.columns[axis][i], rel=1e-12)
        middle = (chain.weights[0] + chain.weights[-1]) / 2
        assert chain.weights[-1] - middle == pytest.approx(study.columns["theta"][i] * middle, abs=1e-9)


def test_runs_of_a_map_go_on_after_the_first_global_slip():
    config = with_ensembles(maps={"points": 9})
    found = run_members(make_study(config, "map_friction"), 0, 9)
    assert found["reached"].all()
    assert (found["n_global"] > 1).all()


def test_the_resolution_study_has_each_chain_once_without_noise_and_as_often_with_it_as_time_allows():
    settings = {"n_blocks": [2, 200], "seconds_per_point": 0.1, "least_runs": 3, "most_runs": 9}
    config = with_ensembles(resolution=settings)
    study = make_study(config, "resolution_members")
    for scene in CONFIG["fig13"]:
        for n_blocks, n_runs in ((2, 9), (200, 3)):
            members = rows(study, scene=scene, n_blocks=n_blocks)
            assert len(members) == n_runs
            assert (study.columns["load_noise"][members] == 0.0).sum() == 1


def test_the_estimate_comes_nearer_to_kinetic_friction_with_every_block():
    estimate = resolution.estimated_mu_sapp([1, 10, 200, 10**9], 0.7, 0.45)
    np.testing.assert_allclose(estimate, [0.95, 0.5, 0.4525, 0.45], rtol=1e-8)


def test_an_exact_law_is_carried_on_exactly():
    n_blocks = np.array([5, 20, 40, 80, 160])
    laws = {"mu_sapp": 0.45 + 0.5 / n_blocks, "events_kept": 2.0 * n_blocks**0.75}
    laws["mu_sapp"][0] = 9.9  # below the smallest N that takes part
    table = pd.concat(
        pd.DataFrame({"scene": "s", "quantity": name, "n_blocks": n_blocks, "q50": values})
        for name, values in laws.items()
    )
    found = resolution.extrapolation_table(table, from_n_blocks=20).set_index("quantity")
    assert found.loc["mu_sapp", ["a", "b"]].tolist() == pytest.approx([0.45, 0.5], rel=1e-12)
    assert found.loc["events_kept", ["c", "p"]].tolist() == pytest.approx([2.0, 0.75], rel=1e-12)
    assert found.loc["mu_sapp", "a_error"] < 1e-12
    assert set(found["n_points"]) == {4}


def test_the_errors_of_a_line_are_those_of_the_textbook():
    x, y = np.array([0.0, 1.0, 2.0, 3.0]), np.array([0.0, 1.0, 1.0, 3.0])
    slope, intercept = 0.9, -0.1
    variance = (0.1**2 + 0.2**2 + 0.7**2 + 0.4**2) / 2
    coefficients, errors = resolution.straight_line(x, y)
    assert coefficients.tolist() == pytest.approx([slope, intercept])
    expected = [np.sqrt(variance / 5), np.sqrt(variance * (1 / 4 + 1.5**2 / 5))]
    assert errors.tolist() == pytest.approx(expected)


def test_the_front_of_the_papers_global_slip_is_slower_than_long_waves():
    row = summarise([simulate(Chain.from_slider(), until="global slip")])
    [speed] = resolution.front_speed(np.array([10]), 0.1, row["crossing_time"])
    assert speed == pytest.approx(0.09 / row["crossing_time"][0])
    assert 1000 < speed < 1443


def test_global_slips_of_a_long_run_begin_at_the_largest_load_since_the_one_before():
    run = simulate(Chain.from_slider(), duration=30.0)
    table = long_runs.global_slips(run)
    assert len(table) > 30
    first = run.transitions[run.transitions["time"] <= table["onset_s"][0]]
    assert table["load_before_N"][0] == first["tangential_load"].max()
    assert (table["load_after_N"] < table["load_before_N"]).all()
    statistics = long_runs.long_run_statistics(table.assign(scene="s")).iloc[0]
    assert statistics["n"] == len(table) - 1
    assert statistics["mu_first"] == pytest.approx(0.48576, abs=1e-5)
    assert statistics["least"] <= statistics["q05"] <= statistics["mean"] <= statistics["largest"]
