"""Errors in the configuration: one line says which value, where, and what it must be."""

import copy
import math
import re

import pytest
from places import ROOT
from settings import CONFIG as PAPERS
from settings import STUDIES

from maegawa2010.config import check_config, load_config, read_file
from maegawa2010.scenes import scene_slider
from precursors.model.chain import Chain

SCHEMA = ROOT / "workflow/config.schema.yaml"
MISSING = object()
STEEP = {"title": "steep", "theta": 0.9}


# Key, value, and words of the error message.
MEASURED = {"title": "as measured", "weights": [30.0, 40.0, 50.0]}
WRONG = [
    ("chain.youngs_modulus", "2.5e9", ["chain.youngs_modulus: '2.5e9' is not of type"]),
    ("scenes.fig10.mu_k", 0.9, ["scenes.fig10: ", "mu_k", "0.9", "mu_s = 0.7"]),
    ("chain.n_blocks", 0, ["chain.n_blocks: 0", "minimum of 1"]),
    ("chain.length", math.nan, ["chain: ", "length", "nan"]),
    ("chain.length", MISSING, ["chain: 'length' is a required property"]),
    (
        "chain.mass",
        0.0012,
        ["chain has no key 'mass': it must be one of n_blocks, mu_s"],
    ),
    ("speed", 1.0, ["top level has no key 'speed': it must be one of chain"]),
    ("scnes", {}, ["top level has no key 'scnes': did you mean 'scenes'?"]),
    (
        "scenes.steep",
        {"titel": "steep", "theta": 0.9},
        ["scenes.steep has no key 'titel': did you mean 'title'?"],
    ),
    (
        "scenes.fig10.load_cell_b",
        MISSING,
        ["'load_cell_a'] must have exactly one of these: theta, both load_cell_a"],
    ),
    ("scenes.fig10.load_cell_b", 5000.0, ["scenes.fig10: ", "-1"]),
    (
        "scenes.fig10.normal_load",
        500.0,
        ["scenes.fig10: ", "must not have normal_load beside load cells", "sum"],
    ),
    (
        "scenes.steep",
        STEEP | {"theta": 1.1},
        ["scenes.steep.theta: 1.1 must be a number between -1 and 1, or"],
    ),
    ("scenes.st eep", STEEP, ["scenes: 'st eep' must be a name of at most 64 letters"]),
    (
        "scenes.steep",
        MEASURED | {"theta": 0},
        [
            "scenes.steep: ['title', 'weights', 'theta'] must have exactly one of these: theta"
        ],
    ),
    (
        "scenes.steep",
        MEASURED | {"normal_load": 120.0},
        ["must not have normal_load or n_blocks beside weights"],
    ),
    (
        "scenes.steep",
        MEASURED | {"weights": "none.csv"},
        ["scenes.steep: ", "none.csv: No such file"],
    ),
    ("scenes.steep", MEASURED | {"weights": [0.0, 0.0]}, ["scenes.steep: ", "weights"]),
    (
        "fig13",
        ["fig10", "fig11", "fig99"],
        ["fig13 has 'fig99': it must be one of fig10, fig11, fig12"],
    ),
    ("figure_formats", ["doc"], ["figure_formats[0]: 'doc' is not one of"]),
    ("noise.sede", 1, ["noise has no key 'sede': did you mean 'seed'?"]),
    ("noise", [1], ["noise: [1] is not of type 'object'"]),
    ("noise.runs", 0, ["noise.runs: 0 is less than the minimum of 1"]),
    ("horizon.proved.uniform.mass", 1, ["proved.uniform: ", "'mass' was unexpected"]),
    ("figure.width_mm", 17, ["the width must be between 40 and 400 mm, but is 17"]),
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
    """Keys of all numbers, texts and lists of a configuration."""
    if isinstance(value, dict):
        return [
            leaf
            for key, inner in value.items()
            for leaf in leaves(inner, (*where, key))
        ]
    return [".".join(where)]


def refused(config):
    with pytest.raises(ValueError, match=r"\Aconfiguration: [^\n]+\Z") as error:
        check_config(config, STUDIES, SCHEMA)
    return str(error.value)


def test_the_papers_configuration_is_accepted():
    check_config(PAPERS, STUDIES, SCHEMA)
    assert [
        Chain.from_slider(**scene_slider(PAPERS, name)).normal_load
        for name in PAPERS["scenes"]
    ] == pytest.approx([400.0] * 3)
    assert [scene_slider(PAPERS, name)["theta"] for name in PAPERS["scenes"]] == [
        0.0,
        -5 / 6,
        5 / 6,
    ]
    for theta in (-1, 0.5, "5/6"):
        steep = changed("scenes.steep", STEEP | {"theta": theta})
        check_config(steep, STUDIES, SCHEMA)


@pytest.mark.parametrize(("key", "value", "words"), WRONG)
def test_a_wrong_value_is_named_with_its_place_and_rule(key, value, words):
    line = refused(changed(key, value))
    assert [word for word in words if word not in line] == [], line


def test_every_value_of_the_file_is_checked():
    keys = [leaf for leaf in leaves(PAPERS) if "title" not in leaf]
    lines = {key: refused(changed(key, {"a": 1})) for key in keys}
    assert [key for key, line in lines.items() if key.split(".")[-1] not in line] == []


def test_a_section_is_checked_by_the_keys_of_its_own_study():
    mine = {"step": [1, 2], "noise": "white", "lowest": 1e-5}
    studies = STUDIES | {"mine": mine}
    check_config(PAPERS | {"mine": mine}, studies, SCHEMA)
    with pytest.raises(ValueError, match="mine has no key 'lower': did you mean"):
        check_config(PAPERS | {"mine": {"lower": 1e-5}}, studies, SCHEMA)


def test_an_error_names_the_file_with_the_wrong_value():
    mine = {"noise": {"sede": 1, "runs": 0}}
    files = {"config.yaml": PAPERS, "mine.yaml": mine}
    for given, line in (
        (mine, "mine.yaml: noise has no key 'sede': did you mean 'seed'?"),
        ({"noise": {"runs": 0}}, "mine.yaml: noise.runs: 0 is less than the minimum"),
    ):
        with pytest.raises(ValueError, match=re.escape(line)):
            load_config(PAPERS | given, files, ROOT / "workflow")


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (
            "a: 1\nb: {c: 2, c: 3}\n",
            "the key 'c' is repeated in line 2, column 11",
        ),
        ("a:\n\tb: 1\n", "cannot start any token in line 2, column 1"),
        (
            "a: 1e-5\n",
            "1e-5 is text to YAML: write a number as 2.5e+9 and not as 2.5e9",
        ),
        ("", "must be a table of keys and values"),
        ("a: 1\n---\na: 2\n", "but found another document in line 2, column 1"),
    ],
)
def test_a_file_that_is_not_plain_yaml_is_refused(tmp_path, text, words):
    path = tmp_path / "mine.yaml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(ValueError, match=r"\A[^\n]+mine.yaml[^\n]+\Z") as error:
        read_file(path)
    assert words in str(error.value)
    assert len(str(error.value)) < 400


def test_numbers_and_quoted_texts_are_accepted(tmp_path):
    path = tmp_path / "mine.yaml"
    path.write_text("""a: [0, -1, 0.5, 2.5e+9, "1e-5", text, true]\n""")
    assert read_file(path)["a"] == [0, -1, 0.5, 2.5e9, "1e-5", "text", True]


def test_measured_normal_loads_come_from_a_list_or_a_file(tmp_path):
    (tmp_path / "loads.csv").write_text("30\n40\n50\n")
    for weights in (MEASURED["weights"], str(tmp_path / "loads.csv")):
        config = changed("scenes.steep", MEASURED | {"weights": weights})
        check_config(config, STUDIES, SCHEMA)
        chain = Chain.from_slider(**scene_slider(config, "steep"))
        assert chain.weights.tolist() == [30.0, 40.0, 50.0]
        slider = scene_slider(config, "steep")
        assert (slider["n_blocks"], slider["normal_load"]) == (3, 120.0)
        assert math.isnan(slider["theta"])


def test_numbers_of_the_chain_may_be_text_on_the_command_line():
    given = changed("chain.n_blocks", "12")
    given["chain"]["youngs_modulus"] = "3e9"
    chain = load_config(given, {}, ROOT / "workflow")["chain"]
    assert (chain["n_blocks"], chain["youngs_modulus"]) == (12, 3e9)
    assert isinstance(chain["n_blocks"], int)
    given["chain"]["mu_k"] = "low"
    with pytest.raises(ValueError, match=r"chain.mu_k: 'low' is not of type 'number'"):
        load_config(given, {}, ROOT / "workflow")
