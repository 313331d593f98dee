"""A bad configuration or directory is refused in one line, and nothing is touched."""

import copy
import math

import pytest
import yaml
from conftest import ROOT

from precursors.config import check_config, scene_chain, scene_names
from precursors.proof import scene_exact_chain

SCHEMA = ROOT / "workflow/schemas/config.schema.yaml"
PAPERS = yaml.safe_load((ROOT / "config.yaml").read_text(encoding="utf-8"))
MISSING = object()
STEEP = {"title": "steep", "theta": 0.9}

# key, value, and words that the line must hold: which value, where, and what is allowed
BAD = [
    ("chain.youngs_modulus", "2.5e9", ["chain.youngs_modulus", "'2.5e9'", "write 2.5e+9", "> 0", "[Pa]"]),
    ("chain.cross_section", "1e-4", ["chain.cross_section", "write 1.0e-4", "[m^2]"]),
    ("chain.mu_s", "high", ["chain.mu_s", "'high' is text", "a number >= 0"]),
    ("chain.mu_s", math.nan, ["chain.mu_s = nan", "finite"]),
    ("chain.normal_load", math.inf, ["chain.normal_load = inf", "finite"]),
    ("chain.mu_k", 0.8, ["chain.mu_k = 0.8", "mu_s = 0.7", "0 <= mu_k <= mu_s"]),
    ("scenes.fig10.mu_k", 0.9, ["scenes.fig10.mu_k = 0.9", "mu_s = 0.7", "0 <= mu_k <= mu_s"]),
    ("chain.drive_stiffness", -0.8e6, ["chain.drive_stiffness = -800000.0", "> 0", "[N/m]"]),
    ("chain.n_blocks", 0, ["chain.n_blocks = 0", "a whole number >= 1"]),
    ("chain.n_blocks", 2.5, ["chain.n_blocks = 2.5", "a whole number >= 1"]),
    ("chain.n_blocks", 10.0, ["n_blocks = 10.0", "a whole number >= 1"]),
    ("chain.n_blocks", True, ["chain.n_blocks = True", "a whole number >= 1"]),
    ("chain.length", None, ["chain.length = (empty)", "> 0", "[m]"]),
    ("chain.length", MISSING, ["chain.length is missing", "> 0", "[m]"]),
    ("chain.mass", 0.0012, ["chain.mass is an unknown key", "slider_mass"]),
    ("chain", [1, 2], ["chain = [1, 2]", "a table of keys and values"]),
    ("duration", 0, ["duration = 0", "> 0", "[s]"]),
    ("scenes", {}, ["scenes = {}", "at least 1 entry"]),
    ("scenes.fig10.load_cel_a", 1.0, ["scenes.fig10.load_cel_a is an unknown key", "load_cell_a"]),
    (
        "scenes.fig10.load_cell_b",
        MISSING,
        ["scenes.fig10 gives load_cell_a", "both load_cell_a and load_cell_b"],
    ),
    ("scenes.fig10.theta", 0.1, ["scenes.fig10 gives theta and load_cell_a", "either theta or both"]),
    ("scenes.fig10.load_cell_b", 5000.0, ["scenes.fig10: load_a = 200.0 N", "-1 <= theta <= 1"]),
    ("scenes.fig10.normal_load", 500.0, ["scenes.fig10.normal_load = 500.0", "sum"]),
    (
        "scenes.fig10.paper.events_kept",
        "nine",
        ["scenes.fig10.paper.events_kept", "'nine'", "a whole number >= 1"],
    ),
    ("scenes.steep", {"title": "steep"}, ["scenes.steep gives neither", "either theta or both"]),
    ("scenes.steep", STEEP | {"theta": 1.1}, ["scenes.steep.theta = 1.1", "<= 1"]),
    ("scenes.steep", STEEP | {"theta": "7/6"}, ["scenes.steep", "'7/6'", "-1 <= theta <= 1"]),
    ("scenes.steep", STEEP | {"theta": "1/0"}, ["scenes.steep", "'1/0'", "-1 <= theta <= 1"]),
    ("scenes.steep", STEEP | {"theta": "__import__('os')"}, ["scenes.steep.theta", "__import__", "5/6"]),
    ("scenes.fig13", STEEP, ["scenes.fig13", "fig09, fig13"]),
    ("scenes.Fig09", STEEP, ["scenes.Fig09", "fig09, fig13"]),
    ("scenes.map_mine", STEEP, ["scenes.map_mine", "map_..."]),
    ("scenes.two words", STEEP, ["'two words'", "letters, digits, _ and -"]),
    ("scenes.a/b", STEEP, ["'a/b'", "letters, digits, _ and -"]),
    ("scenes." + 65 * "a", STEEP, [65 * "a", "letters, digits, _ and -"]),
    ("scenes", {12: STEEP}, ["scenes", "key 12", "a name or quotes"]),
    ("scenes.steep", STEEP | {"model": "dynamic"}, ["scenes.steep.model = 'dynamic'", "statics, law, rigid"]),
    ("scenes.steep", STEEP | {"model": 3}, ["scenes.steep.model = 3", "a text"]),
    (
        "scenes.steep",
        STEEP | {"model": "law", "quantities": ["mu_sapp", "waveform"]},
        ["scenes.steep.quantities", "'waveform'", "the model 'law'", "front_loads, mu_sapp"],
    ),
    ("scenes.steep", STEEP | {"quantities": []}, ["scenes.steep.quantities = []"]),
    ("scenes.steep", STEEP | {"quantities": ["load"]}, ["'load'", "the model 'chain'", "first_load"]),
    (
        "scenes.steep",
        STEEP | {"viscosity": 54.77},
        ["scenes.steep.viscosity = 54.77 [N s/m]", "the model 'chain'", "viscous, interface, head"],
    ),
    ("scenes.steep", STEEP | {"model": "viscous"}, ["scenes.steep.viscosity is missing", "> 0 [N s/m]"]),
    (
        "scenes.steep",
        STEEP | {"model": "head", "viscosity": 1.0},
        ["scenes.steep.head_mass is missing", "'head'", "[kg]"],
    ),
    (
        "scenes.steep",
        STEEP | {"model": "interface", "interface_stiffness": 0},
        ["scenes.steep.interface_stiffness = 0", "> 0", "[N/m]"],
    ),
    (
        "scenes.steep",
        STEEP | {"quantities": ["mu_sapp"], "duration": 1.0},
        ["scenes.steep.duration", "only answers quantities", "first global slip"],
    ),
    ("scenes.fig10.quantities", ["mu_sapp"], ["scenes.fig10.paper", "only answers quantities"]),
    ("scenes.fig12.model", "quasistatic", ["scenes.fig12.paper", "only answers quantities"]),
    (
        "scenes.fig10",
        STEEP | {"model": "viscous", "viscosity": 54.77},
        ["fig13 names 'fig10'", "the model 'chain' without quantities"],
    ),
    ("resolution_models.models.soft", {"friction": 1.0}, ["models.soft.friction", "relaxation_time"]),
    ("ladder.additions.head_mass", -1.0, ["ladder.additions.head_mass = -1.0", "> 0", "[kg]"]),
    ("scenes.resolution_models", STEEP, ["scenes.resolution_models", "resolution_models"]),
    ("fig13", ["fig10", "fig11", "fig21"], ["fig13", "'fig21'", "fig10, fig11, fig12"]),
    ("fig13", ["fig10", "fig11", "fig11"], ["fig13", "3 different entries"]),
    ("fig13", ["fig10"], ["fig13", "3 different entries"]),
]
# Refused by Snakemake itself in the same way as all others, so a few of them are enough.
THROUGH_SNAKEMAKE = [BAD[i] for i in (0, 3, 6, 14, 28, 31)]


def changed(key, value):
    config = copy.deepcopy(PAPERS)
    table, *rest = config, *key.split(".")
    for name in rest[:-1]:
        table = table[name]
    if value is MISSING:
        del table[rest[-1]]
    else:
        table[rest[-1]] = value
    return config


def test_the_papers_configuration_is_accepted():
    check_config(PAPERS, SCHEMA)
    assert [scene_chain(PAPERS, name).normal_load for name in scene_names(PAPERS)] == pytest.approx(
        [400.0] * 3
    )


@pytest.mark.parametrize("theta", [-1, 0, 1.0, "5/6", "-5/6", "0.5"])
def test_a_scene_may_give_theta_as_a_number_or_a_fraction(theta):
    check_config(changed("scenes.steep", STEEP | {"theta": theta}), SCHEMA)


@pytest.mark.parametrize(("key", "value", "words"), BAD)
def test_a_bad_value_is_named_with_its_place_and_what_is_allowed(key, value, words):
    with pytest.raises(ValueError, match=r"\Aconfiguration: [^\n]+\Z") as error:
        check_config(changed(key, value), SCHEMA)
    for word in words:
        assert word in str(error.value)


@pytest.mark.parametrize(("key", "value", "words"), THROUGH_SNAKEMAKE)
@pytest.mark.parametrize("arguments", [["-c1", "all"], ["-n"]])
def test_snakemake_refuses_a_bad_configuration_in_one_line(finished, key, value, words, arguments):
    (finished.path / "config.yaml").write_text(yaml.safe_dump(changed(key, value)), encoding="utf-8")
    before = finished.results()
    outcome = finished.run(*arguments)
    assert outcome.code != 0
    assert "Traceback" not in outcome.text
    lines = [line for line in outcome.text.splitlines() if "configuration: " in line]
    assert len(lines) == 1
    assert all(word in lines[0] for word in words)
    assert finished.results() == before


@pytest.mark.parametrize("text", ["", "just words", "chain: [1", "- 1\n- 2\n"])
def test_snakemake_refuses_a_file_that_is_no_configuration(finished, text):
    (finished.path / "config.yaml").write_text(text, encoding="utf-8")
    before = finished.results()
    outcome = finished.run("-c1", "all")
    assert outcome.code != 0
    assert "Traceback" not in outcome.text
    assert "Config file" in outcome.text
    assert finished.results() == before


def test_a_file_in_place_of_the_results_directory_is_named(workspace):
    (workspace.path / "results").write_text("mine", encoding="utf-8")
    outcome = workspace.run("-c1", "all")
    assert outcome.code != 0
    assert "Traceback" not in outcome.text
    assert "results is a file: a directory that can be written to is needed there" in outcome.text
    assert (workspace.path / "results").read_text(encoding="utf-8") == "mine"


def test_a_results_directory_that_cannot_be_written_to_is_named(workspace):
    results = workspace.path / "results"
    results.mkdir(mode=0o500)
    try:
        (results / "probe").touch()
        pytest.skip("this user may write anywhere")
    except PermissionError:
        outcome = workspace.run("-c1", "all")
    assert outcome.code != 0
    assert "Traceback" not in outcome.text
    assert "results cannot be written to" in outcome.text


def test_a_scene_of_another_model_has_no_proof():
    config = changed("scenes.steep", STEEP | {"model": "viscous", "viscosity": 54.77})
    with pytest.raises(
        ValueError, match=r"\Ascenes.steep.model = 'viscous': proofs are of the model 'chain'"
    ):
        scene_exact_chain(config, "steep")
