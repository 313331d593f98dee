"""A wrong configuration is refused in one line: which value, where, and what it must be."""

import copy
import math
from pathlib import Path

import pytest
import yaml

from precursors.model.chain import Chain
from precursors.model.config import check_config, check_file, read_numbers
from precursors.model.scenes import scene_chain, scene_slider, scenes_with

ROOT = Path(__file__).parents[2]
SCHEMA = ROOT / "workflow/schemas/config.schema.yaml"
PAPERS = yaml.safe_load((ROOT / "config.yaml").read_text(encoding="utf-8"))
MISSING = object()
STEEP = {"title": "steep", "theta": 0.9}

# Key, value, and words that the line must hold.
MEASURED = {"title": "as measured", "weights": [30.0, 40.0, 50.0]}
WRONG = [
    ("chain.youngs_modulus", "2.5e9", ["a number > 0", "[Pa]", "is '2.5e9'", "text: write 2.5e+09"]),
    ("chain.cross_section", "1e-4", ["[m^2]", "text: write 1.0e-04"]),
    ("chain.mu_k", "0.46", ["'0.46'", "text: write it without quotes", "--configfile"]),
    ("chain.mu_s", "high", ["a number >= 0", "is 'high'"]),
    ("chain.mu_k", 0.8, ["chain: ", "mu_k", "0.8", "mu_s = 0.7"]),
    ("scenes.fig10.mu_k", 0.9, ["scenes.fig10: ", "mu_k", "0.9", "mu_s = 0.7"]),
    ("chain.drive_stiffness", -0.8e6, ["a number > 0", "[N/m]", "is -800000.0"]),
    ("chain.n_blocks", 0, ["a whole number from 1 to 1000", "is 0"]),
    ("chain.n_blocks", 2.5, ["a whole number", "is 2.5"]),
    ("chain.n_blocks", 10.0, ["a whole number", "is 10.0"]),
    ("chain.n_blocks", True, ["a whole number", "is True"]),
    ("chain.length", None, ["a number > 0", "is empty"]),
    ("chain.length", 1e70, ["chain: ", "length", "1e+70"]),
    ("chain.length", MISSING, ["chain: the key 'length' is missing"]),
    ("mu_k", 0.46, ["'mu_k' belongs to chain: --config chain='{mu_k: 0.46}'"]),
    ("chain.mass", 0.0012, ["chain: 'mass' is not a known key", "slider_mass"]),
    ("speed", 1.0, ["top level: 'speed' is not a known key", "scenes"]),
    ("ensembles", MISSING, ["top level: the key 'ensembles' is missing"]),
    ("chain", [1, 2], ["chain must be a table", "is [1, 2]"]),
    ("duration", 0, ["duration must be a number > 0", "[s]", "is 0"]),
    ("scenes", {}, ["at least one scene"]),
    ("scenes.fig10.load_cel_a", 1.0, ["'load_cel_a' is not a known key", "load_cell_a"]),
    (
        "scenes.fig10.load_cell_b",
        MISSING,
        ["scenes.fig10: ", "both load_cell_a and load_cell_b", "is load_cell_a"],
    ),
    ("scenes.fig10.theta", 0.1, ["either theta or both", "is theta and load_cell_a"]),
    ("scenes.fig10.load_cell_b", 5000.0, ["scenes.fig10: ", "-1"]),
    ("scenes.fig10.normal_load", 500.0, ["scenes.fig10: normal_load must not be given", "sum"]),
    (
        "scenes.fig10.paper.events_counted",
        "nine",
        ["scenes.fig10.paper.events_counted", "a whole number >= 1", "'nine'"],
    ),
    ("scenes.steep", {"title": "steep"}, ["scenes.steep: ", "is neither"]),
    ("scenes.steep", STEEP | {"title": ""}, ["scenes.steep.title", "1 to 120 printable characters"]),
    ("scenes.steep", STEEP | {"title": "a\n"}, ["scenes.steep.title", "one line"]),
    ("scenes.steep", STEEP | {"title": "a\n.. include:: /etc/passwd"}, ["scenes.steep.title", "one line"]),
    ("scenes.steep", STEEP | {"title": "a\u202eb"}, ["scenes.steep.title", "printable"]),
    ("scenes.steep", STEEP | {"title": " a"}, ["scenes.steep.title", "printable"]),
    ("scenes.steep", STEEP | {"theta": 1.1}, ["scenes.steep.theta", "from -1 to 1", "is 1.1"]),
    ("scenes.steep", STEEP | {"theta": "7/6"}, ["scenes.steep: ", "'7/6'", "-1"]),
    ("scenes.steep", STEEP | {"theta": "1/0"}, ["scenes.steep: ", "'1/0'"]),
    (
        "scenes.steep",
        STEEP | {"theta": "__import__('os')"},
        ["scenes.steep.theta", 'a fraction such as "5/6"'],
    ),
    ("scenes.Fig13", STEEP, ["the name 'Fig13'", "not the name of another figure"]),
    ("scenes.map_mine", STEEP, ["the name 'map_mine'"]),
    ("scenes.steep\n", STEEP, ["the name 'steep\\n'"]),
    ("scenes.steep", STEEP | {"theta": "5/6\n"}, ["scenes.steep.theta", "'5/6\\n'"]),
    ("scenes.two words", STEEP, ["the name 'two words'", "letters, digits, _ and -"]),
    ("scenes.a/b", STEEP, ["the name 'a/b'"]),
    ("scenes." + 65 * "a", STEEP, [65 * "a"]),
    ("scenes", {12: STEEP}, ["the name 12"]),
    (
        "scenes.steep",
        STEEP | {"model": "dynamic"},
        ["scenes.steep.model", "one of statics, law, rigid", "'dynamic'"],
    ),
    ("scenes.fig10.weights", [40.0] * 10, ["load_cell_a must not be given beside weights"]),
    ("scenes.steep", MEASURED | {"n_blocks": 3}, ["n_blocks must not be given beside weights"]),
    ("scenes.steep", MEASURED | {"weights": "none.csv"}, ["none.csv: no such file"]),
    ("scenes.steep", MEASURED | {"weights": [40.0, -1.0]}, ["weights[1]", "a number >= 0", "-1.0"]),
    ("fig13", ["fig10", "fig11", "fig21"], ["fig13 holds 'fig21'", "fig10, fig11, fig12"]),
    ("fig13", ["fig10", "fig11", "fig11"], ["three different scenes"]),
    ("fig13", ["fig10"], ["three different scenes"]),
    ("scenes.fig12.model", "quasistatic", ["fig13 holds 'fig12'", "fig10, fig11"]),
    ("reproduction.theta", ["7/6"], ["theta in reproduction", "'7/6'"]),
    ("reproduction.load_drop", [0.0], ["reproduction.load_drop[0]", "a number > 0"]),
    ("accuracy.proved.uniform.mu_k", 0.8, ["accuracy.proved.uniform: ", "mu_k", "0.8"]),
    ("accuracy.proved.two words", {"theta": 0}, ["the name 'two words'"]),
    ("accuracy.compared", ["none"], ["holds 'none'", "trailing"]),
    ("hierarchy.tolerances.waveforms", 0.1, ["the name 'waveforms'", "waveform"]),
    ("ensembles.chunks", 0, ["ensembles.chunks", "a whole number from 1 to 10000", "is 0"]),
    ("ensembles.resolution.runs", [40], ["resolution.runs", "one number for each of n_blocks"]),
    ("ensembles.noise.runs", 10**7, ["a whole number from 1 to 1000000", "is 10000000"]),
    ("hierarchy.repetitions", 10**6, ["a whole number >= 5 and up to 1000"]),
    ("duration", 1e7, ["up to 1e+6", "is 10000000.0"]),
    ("ensembles.noise.seed", 20.5, ["a whole number >= 0", "is 20.5"]),
]


def changed(key, value):
    """The paper's configuration with one value changed."""
    config = copy.deepcopy(PAPERS)
    table = config
    *parents, last = key.split(".")
    for name in parents:
        table = table[name]
    if value is MISSING:
        del table[last]
    else:
        table[last] = value
    return config


def leaves(value, where=()):
    """Places of all numbers, texts and lists of a configuration."""
    if isinstance(value, dict):
        return [leaf for key, inner in value.items() for leaf in leaves(inner, (*where, key))]
    return [".".join(where)]


def refused(config):
    with pytest.raises(ValueError, match=r"\Aconfiguration: [^\n]+\Z") as error:
        check_config(config, SCHEMA)
    return str(error.value)


def test_the_papers_configuration_is_accepted():
    check_config(PAPERS, SCHEMA)
    assert scenes_with(PAPERS, "run") == ["fig10", "fig11", "fig12"]
    assert [scene_chain(PAPERS, name).normal_load for name in PAPERS["scenes"]] == pytest.approx([400.0] * 3)
    assert [scene_slider(PAPERS, name)["theta"] for name in PAPERS["scenes"]] == [0.0, -5 / 6, 5 / 6]


@pytest.mark.parametrize("theta", [-1, 0, 1.0, "5/6", "-5/6", "0.5"])
def test_a_scene_may_give_theta_as_a_number_or_a_fraction(theta):
    check_config(changed("scenes.steep", STEEP | {"theta": theta}), SCHEMA)


def test_a_scene_that_names_a_model_is_answered_and_not_run():
    config = changed("scenes.rough", STEEP | {"model": "quasistatic"})
    config["scenes"]["quick"] = STEEP | {"model": "chain"}
    check_config(config, SCHEMA)
    assert scenes_with(config, "answers") == ["rough", "quick"]


@pytest.mark.parametrize(("key", "value", "words"), WRONG)
def test_a_wrong_value_is_named_with_its_place_and_what_it_must_be(key, value, words):
    line = refused(changed(key, value))
    assert [word for word in words if word not in line] == [], line


@pytest.mark.parametrize("key", [leaf for leaf in leaves(PAPERS) if "title" not in leaf])
@pytest.mark.parametrize("value", [None, {"a": 1}, math.nan, "much"], ids=["empty", "table", "nan", "text"])
def test_every_value_of_the_file_is_checked(key, value):
    assert key.split(".")[-1] in refused(changed(key, value))


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("a: 1\nb: {c: 2, c: 3}\n", "the key 'c' stands there twice in line 2, column 11"),
        ("a:\n\tb: 1\n", "found character '\\t' that cannot start any token in line 2, column 1"),
        ("a: 1\t\n", "found character '\\t' that cannot start any token in line 1, column 5"),
        ("a: 010\n", "010 is not plain: write a decimal number, or a text in quotes in line 1, column 4"),
        ("a: [1, 1:30]\n", "1:30 is not plain"),
        ("a: -1:30.5\n", "-1:30.5 is not plain"),
        ("a: [1\n", "line 2, column 1"),
        ("a: !!python/tuple [1]\n", "could not determine a constructor"),
        ("- 1\n", "must be a table of keys and values"),
        ("", "must be a table of keys and values"),
        ("a: \x07\n", "special characters are not allowed"),
    ],
)
def test_a_file_that_is_not_plain_yaml_is_refused_with_its_place(tmp_path, text, words):
    path = tmp_path / "mine.yaml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(ValueError, match=r"\A[^\n]+mine.yaml[^\n]+\Z") as error:
        check_file(path)
    assert words in str(error.value)


def test_plain_numbers_and_quoted_texts_are_accepted(tmp_path):
    path = tmp_path / "mine.yaml"
    path.write_text('a: [0, -1, 0.5, 2.5e+9, 1_000, "010", "1:30"]\n', encoding="utf-8")
    check_file(path)


def test_measured_normal_loads_are_those_of_the_blocks_from_a_list_or_a_file(tmp_path):
    (tmp_path / "loads.csv").write_text("30\n40\n50\n")
    for weights in (MEASURED["weights"], str(tmp_path / "loads.csv")):
        config = changed("scenes.steep", MEASURED | {"weights": weights})
        check_config(config, SCHEMA)
        chain = scene_chain(config, "steep")
        assert chain.weights.tolist() == [30.0, 40.0, 50.0]
        assert chain == Chain.from_slider(n_blocks=3, normal_load=120.0, theta=0.25)
        slider = scene_slider(config, "steep")
        assert (slider["n_blocks"], slider["normal_load"]) == (3, 120.0)
        assert math.isnan(slider["theta"])


def test_numbers_of_the_chain_may_be_text_as_in_config_of_the_command_line():
    read = read_numbers({"n_blocks": "12", "youngs_modulus": "3e9", "mu_s": 0.7, "mu_k": "low"})
    assert read == {"n_blocks": 12, "youngs_modulus": 3e9, "mu_s": 0.7, "mu_k": "low"}
    assert isinstance(read["n_blocks"], int)
    assert read_numbers(5) == 5
