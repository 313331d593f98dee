"""A bad configuration or directory is refused in one line, and nothing is touched."""

import copy
import math
import shutil
from importlib import import_module

import pytest
import yaml
from conftest import ROOT, Workspace

from precursors import Run
from precursors import methods as integrators
from precursors.accuracy.proof import scene_exact_chain
from precursors.ensembles.cost import LONGEST_RUN
from precursors.ensembles.scaling_text import GROWS_FROM
from precursors.model.config_check import check_config, scene_seconds, trace_seconds
from precursors.model.config_schema import allowed
from precursors.model.scenes import scene_chain, scene_names

SCHEMA = ROOT / "workflow/schemas/config.schema.yaml"
SCHEMA_ITSELF = yaml.safe_load(SCHEMA.read_text(encoding="utf-8"))
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
        STEEP | {"viscosity": 54.77},
        ["scenes.steep.viscosity = 54.77", "the model 'chain'", "viscous, interface, head"],
    ),
    ("scenes.steep", STEEP | {"model": "viscous"}, ["scenes.steep.viscosity is missing", "a number > 0"]),
    (
        "scenes.steep",
        STEEP | {"model": "head", "viscosity": 1.0},
        ["scenes.steep.head_mass is missing", "'head'"],
    ),
    (
        "scenes.steep",
        STEEP | {"model": "interface", "interface_stiffness": 0},
        ["scenes.steep.interface_stiffness = 0", "> 0", "[N/m]"],
    ),
    ("scenes.fig12.model", "quasistatic", ["scenes.fig12.paper", "only answers quantities"]),
    (
        "scenes.fig10",
        STEEP | {"model": "viscous", "viscosity": 54.77},
        ["fig13 names 'fig10'", "scenes without `model:`"],
    ),
    (
        "scenes.steep",
        STEEP | {"model": "chain", "duration": 1.0},
        ["scenes.steep.duration", "only answers quantities", "first global slip"],
    ),
    ("resolution_models.theta", "-3/2", ["resolution_models.theta: theta = '-3/2'"]),
    ("resolution_models.models.soft", {"friction": 1.0}, ["models.soft.friction", "relaxation_time"]),
    ("ladder.additions.head_mass", -1.0, ["ladder.additions.head_mass = -1.0", "> 0", "[kg]"]),
    ("scenes.resolution_models", STEEP, ["scenes.resolution_models", "resolution_models"]),
    ("fig13", ["fig10", "fig11", "fig21"], ["fig13", "'fig21'", "fig10, fig11, fig12"]),
    ("fig13", ["fig10", "fig11", "fig11"], ["fig13", "3 different entries"]),
    ("fig13", ["fig10"], ["fig13", "3 different entries"]),
    ("horizon.chains.uniform.theta", "7", ["horizon.chains.uniform: theta = '7'", "-1 <= theta <= 1"]),
    ("horizon.chains.uniform.mu_k", 0.8, ["horizon.chains.uniform: mu_k = 0.8", "mu_s = 0.7"]),
    ("horizon.chains.uniform.duration", 0.1, ["horizon.chains.uniform.duration = 0.1", "more than 0.35 s"]),
    ("horizon.chains.uniform.n_blocks", 1000, ["horizon.chains.uniform would take", "longest_run"]),
    ("horizon.chains.null", {"theta": 0}, ["horizon.chains.null", "give this name back"]),
    ("horizon.chains.two words", {"theta": 0}, ["horizon.chains.two words", "a letter, then"]),
    ("resolution_models.models.nan", {}, ["resolution_models.models.nan", "give this name back"]),
    ("scenes.Fig10", STEEP, ["scenes.Fig10 differs from fig10 in capitals alone", "one of the two"]),
    ("horizon.chains.Uniform", {"theta": 0}, ["horizon.chains.Uniform differs from uniform in capitals"]),
    ("resolution_models.models.Plain", {}, ["models.Plain differs from plain in capitals"]),
    ("scenes.None", STEEP, ["scenes.None", "give this name back"]),
    ("definitions.theta", ["7"], ["definitions.theta[0]: theta = '7'", "-1 <= theta <= 1"]),
    ("definitions.theta", ["5/6", "0/3"], ["definitions.theta[1] = '0/3'", "0 < theta <= 1"]),
    ("definitions.theta", [0.5, "1/2"], ["definitions.theta[1] = '1/2'", "0.5 too", "once"]),
    (
        "accuracy.default.first_slip.rk45",
        "sweep",
        ["accuracy.default.first_slip.rk45", "exact, heyoka", "rk4"],
    ),
    ("accuracy.full.whole_run.rk4", "swep", ["whole_run.rk4 = 'swep'", 'the word "sweep"']),
    ("accuracy.full.whole_run.rk4", [0.0], ["whole_run.rk4[0] = 0.0", ">= 1e-16 and <= 1", "step [s]"]),
    ("step_sweep.full.coarsest", 1e-10, ["step_sweep.full.finest = 1e-09 [s]", "coarsest = 1e-10 s"]),
    ("step_sweep.full.finest_every_step", 1e-12, ["finest_every_step = 1e-12", ">= 1e-09"]),
    ("step_sweep.full.finest_every_step", 1e-4, ["step_sweep.full.finest_every_step = 0.0001", "coarsest"]),
    ("maps.theta", [0.5, -0.5], ["maps.theta = [0.5, -0.5]", "the lower value, then the upper"]),
    ("maps.n_blocks", [25, 2], ["maps.n_blocks = [25, 2]", "the lower value, then the upper"]),
    ("maps.drive_velocity", [1e-3, 1e-3], ["maps.drive_velocity = [0.001, 0.001]", "the lower value"]),
    ("maps.friction_ratio", [0.1, 1.0], ["maps.friction_ratio[1] = 1.0", "> 0 and < 1"]),
    ("maps.drive_velocity", [1e-70, 1e-3], ["maps.drive_velocity: drive_velocity = 1e-70", "1e-60"]),
    ("maps.stiffness_ratio", [1e-70, 1.0], ["maps.stiffness_ratio: drive_stiffness", "1e-60"]),
    ("maps.loadings", 0.5, ["maps.loadings = 0.5", ">= 1"]),
    ("long_runs.duration", 0.5, ["long_runs.duration = 0.5", "fig11", "at least 4.004 s"]),
    ("maps.loadings", 1e9, ["maps.", "would take", "longest_run"]),
    ("maps.friction_ratio", [0.1], ["maps.friction_ratio = [0.1]", "a list of 2 entries"]),
    ("resolution.least_runs", 41, ["resolution.least_runs = 41", "most_runs = 40"]),
    ("spread.parameters", [1e-3, 0.4], ["spread.parameters[1] = 0.4", "mu_k", "up to 0.357"]),
    ("spread.loads", [], ["spread.loads = []", "a list of at least 1 different entry"]),
    ("scaling.n_blocks", [2, 5], ["scaling.n_blocks = [2, 5]", "at least 2 of them >= 20"]),
    ("scaling.durations", [3.0, 1e9], ["scaling.durations would take", "longest_run"]),
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


def test_a_table_that_no_scene_uses_as_it_is_is_looked_at_too():
    """Maps and definitions take `chain` itself."""
    config = changed("chain.mu_k", 0.8)
    for scene in config["scenes"].values():
        scene["mu_k"] = 0.45
    with pytest.raises(ValueError, match=r"\Aconfiguration: chain: mu_k = 0.8 is larger than mu_s = 0.7"):
        check_config(config, SCHEMA)


def test_a_chain_to_be_proved_has_the_papers_values_whatever_the_chain_of_the_scenes_has():
    """As in `ExactChain.from_slider`: 100 blocks would be refused for what their proof takes."""
    check_config(changed("chain.n_blocks", 100), SCHEMA)
    with pytest.raises(ValueError, match=r"horizon\.chains\.uniform would take"):
        check_config(changed("horizon.chains.uniform.n_blocks", 100), SCHEMA)


def test_a_scene_whose_trace_would_take_too_long_is_refused():
    """Its run alone would be allowed, and is where the scene has no trace."""
    config = changed("scenes.steep", STEEP | {"theta": 0.1, "duration": 1e6})
    assert (
        0.2 * LONGEST_RUN < 2 * scene_seconds(config, "steep") < LONGEST_RUN < trace_seconds(config, "steep")
    )
    with pytest.raises(ValueError, match=r"\Aconfiguration: scenes.steep would take about"):
        check_config(config, SCHEMA)
    only_answers = changed("scenes.steep", STEEP | {"model": "chain"})
    assert trace_seconds(only_answers, "steep") == 0.0


def test_the_schema_knows_all_methods_and_no_others():
    modules = [import_module(f"precursors.methods.{name}") for name in integrators.MODULES]
    names = SCHEMA_ITSELF["$defs"]["sweeps"]["propertyNames"]["enum"]
    assert sorted(names) == sorted(method.name for module in modules for method in module.METHODS)


def test_the_schema_wants_the_sizes_that_growth_is_fitted_to():
    sizes = SCHEMA_ITSELF["properties"]["scaling"]["properties"]["n_blocks"]
    assert sizes["contains"] == {"minimum": GROWS_FROM}


# A part of a schema, and what it allows in words: every keyword that the schema has, alone or with another.
IN_WORDS = [
    ({"type": "number"}, "a number"),
    ({"type": "integer", "minimum": 2}, "a whole number >= 2"),
    ({"type": "number", "exclusiveMinimum": 0, "exclusiveMaximum": 1}, "a number > 0 and < 1"),
    ({"type": "number", "minimum": -1, "maximum": 1}, "a number >= -1 and <= 1"),
    ({"type": "number", "description": "time [s]."}, "a number (time [s])"),
    ({"type": "string", "minLength": 1}, "a text of at least 1 character"),
    (
        {"type": "string", "minLength": 1, "maxLength": 120},
        "a text of at least 1 and at most 120 characters",
    ),
    ({"type": "string", "pattern": "^a", "description": "with an a"}, "a text (with an a)"),
    ({"enum": ["a", "b"]}, "one of a, b"),
    ({"type": "object", "minProperties": 1}, "a table of keys and values with at least 1 entry"),
    ({"type": "array"}, "a list"),
    ({"type": "array", "minItems": 1}, "a list of at least 1 entry"),
    ({"type": "array", "maxItems": 3}, "a list of at most 3 entries"),
    ({"type": "array", "minItems": 2, "maxItems": 2}, "a list of 2 entries"),
    ({"type": "array", "minItems": 3, "maxItems": 3, "uniqueItems": True}, "a list of 3 different entries"),
    ({"type": "array", "minItems": 2, "uniqueItems": True}, "a list of at least 2 different entries"),
    ({"type": "array", "uniqueItems": True}, "a list of different entries"),
    (
        {"type": "array", "minItems": 2, "contains": {"minimum": 20}, "minContains": 2},
        "a list of at least 2 entries, at least 2 of them >= 20",
    ),
    (
        {"type": ["array", "string"], "minItems": 1, "pattern": "^sweep$", "description": 'or "sweep"'},
        'a list of at least 1 entry or a text (or "sweep")',
    ),
    ({"type": ["number", "string"], "maximum": 1, "pattern": "^."}, "a number <= 1 or a text"),
]
# These say by themselves, or by their error, what they mean.
NOT_IN_WORDS = {
    "$schema",
    "$ref",
    "$defs",
    "title",
    "properties",
    "additionalProperties",
    "required",
    "items",
}
NOT_IN_WORDS |= {"propertyNames"}


@pytest.mark.parametrize(("part", "words"), IN_WORDS)
def test_what_a_part_of_the_schema_allows_is_said_in_words(part, words):
    assert allowed(part) == words


def keywords(part):
    """All keywords of a schema."""
    for key, value in part.items():
        yield key
        if key in ("properties", "$defs"):
            for inner in value.values():
                yield from keywords(inner)
        elif isinstance(value, dict):
            yield from keywords(value)


def test_no_keyword_of_the_schema_is_without_words():
    assert set(keywords(SCHEMA_ITSELF)) - NOT_IN_WORDS <= {key for part, _ in IN_WORDS for key in part}


@pytest.fixture(scope="module")
def finished(_finished, tmp_path_factory):
    """Shared by tests that bring a configuration each: where it is refused, all else stays as it is."""
    workspace = Workspace(tmp_path_factory.mktemp("bad") / "copy")
    shutil.copytree(_finished.path, workspace.path)
    return workspace


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


@pytest.mark.parametrize("file", ["config.yaml", "odd.yaml"])
@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("__use_yte__: true", "asks Snakemake to evaluate Python in it"),
        ("duration: 3.0\nduration: 3.0", "the key 'duration' stands twice"),
        ("odd: !!python/tuple [1]", "could not determine a constructor"),
    ],
)
def test_a_configuration_file_of_more_than_plain_values_is_refused(workspace, file, line, words):
    text = (workspace.path / "config.yaml").read_text(encoding="utf-8")
    (workspace.path / file).write_text(f"{line}\n{text}", encoding="utf-8")
    outcome = workspace.run("-n", *(["--configfile", file] if file != "config.yaml" else []))
    assert outcome.code != 0
    assert "Traceback" not in outcome.text
    [said] = [line for line in outcome.text.splitlines() if "configuration: " in line]
    assert words in said


def test_python_in_config_yaml_is_not_evaluated(workspace):
    """It is in a file of the command line, which Snakemake has read before it reads the Snakefile."""
    text = (workspace.path / "config.yaml").read_text(encoding="utf-8")
    python = "odd: ?open('evaluated', 'w').write('')"
    (workspace.path / "config.yaml").write_text(f"__use_yte__: true\n{python}\n{text}", encoding="utf-8")
    assert workspace.run("-n").code != 0
    assert not (workspace.path / "evaluated").exists()


@pytest.mark.parametrize("arguments", [["--config", "duration=3"], ["--configfile", "mine.yaml"]])
def test_plain_values_of_the_command_line_are_taken(compiled_workspace, arguments):
    (compiled_workspace.path / "mine.yaml").write_text("duration: 3\n", encoding="utf-8")
    outcome = compiled_workspace.run("-c1", *arguments, "--", "results/runs/fig10.h5")
    assert outcome.code == 0, outcome.text
    assert Run.load(compiled_workspace.path / "results/runs/fig10.h5").duration == 3.0


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
