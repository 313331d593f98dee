"""What is run: every job once, and after an edit only what the edit touches."""

import re
import shutil

import pandas as pd
import pytest
from conftest import ROOT, Workspace

from precursors import Chain
from precursors.hierarchy.models import answers_table

PAPERS = ("fig10", "fig11", "fig12")
SCENE_JOBS = {"simulate_scene", "tabulate_slips", "tabulate_trace", "draw_scene"}
# Rules that `all` leaves out, and write_provenance, which conftest leaves out of all lists of jobs.
ON_DEMAND = {"answer_scene", "certify_scene", "prove_again", "write_provenance"}
# The paper shows nearly all tables and figures, and is set again when one of them may change.
PAPER = {"write_paper"}
LISTS_OF_SCENES = {
    "tabulate_mu_sapp",
    "tabulate_reproduction",
    "evaluate_claims",
    "draw_fig13",
    "write_explorer",
} | PAPER
STEEP = """\
  steep:
    title: nearly all of the load at the leading edge
    theta: "9/10"
    duration: 1.0
"""
ASKED = """\
  quick:
    title: what a smaller model says
    theta: "9/10"
    model: {model}
"""


def of(*scenes):
    """The jobs of some scenes."""
    return {f"{job} {scene}" for job in SCENE_JOBS for scene in scenes}


def add(workspace, scene):
    workspace.edit("config.yaml", "\nfig13: [", f"{scene}\nfig13: [")


def edit_module(workspace, name):
    """Add a line to a module of the library."""
    assert (workspace.path / f"src/precursors/{name}.py").is_file()
    workspace.append(f"src/precursors/{name}.py", "\nCHANGED = True\n")


@pytest.fixture(scope="module")
def _more_scenes(_finished, tmp_path_factory):
    workspace = Workspace(tmp_path_factory.mktemp("more_scenes") / "copy")
    shutil.copytree(_finished.path, workspace.path)
    add(workspace, STEEP + ASKED.format(model="law"))
    outcome = workspace.pretend("-c2", "all")
    assert outcome.code == 0, outcome.text
    return workspace


@pytest.fixture
def more_scenes(_more_scenes, tmp_path):
    """As `finished`, with two more scenes that were run to the end as well."""
    shutil.copytree(_more_scenes.path, tmp_path / "copy")
    return Workspace(tmp_path / "copy")


def test_a_dry_run_lists_every_job_of_the_paper_and_writes_nothing(untouched):
    workspace, outcome = untouched
    assert outcome.code == 0, outcome.text
    rules = {
        rule
        for file in (ROOT / "workflow/rules").glob("*.smk")
        for text in re.split(r"^(?=rule )", file.read_text(encoding="utf-8"), flags=re.MULTILINE)
        for rule in re.findall(r"\Arule (\w+):", text)
        if "\n    output:" in text
    }
    assert rules - SCENE_JOBS - ON_DEMAND <= outcome.jobs
    assert of(*PAPERS) <= outcome.jobs
    assert not ON_DEMAND & outcome.jobs
    assert not (workspace.path / "results").exists()


def test_a_single_figure_needs_its_own_jobs_only(untouched):
    workspace, _ = untouched
    jobs = workspace.run("-n", "results/figures/fig11.svg").jobs
    # The load axis is the same in Figs. 10 to 12, so that the loads of all three are needed.
    others = {
        f"{job} {scene}" for job in ("simulate_scene", "tabulate_trace") for scene in ("fig10", "fig12")
    }
    assert jobs == of("fig11") | others


def test_a_second_run_has_nothing_to_do(finished):
    before = finished.results()
    outcome = finished.run("-c2", "all")
    assert outcome.code == 0
    assert "Nothing to be done" in outcome.text
    assert finished.results() == before


def test_the_provenance_comes_after_all_figures_and_follows_an_edit(finished):
    outcome = finished.run("-n", "-F", "all")
    (needed,) = re.findall(r"rule write_provenance:\n    input: (.+)", outcome.text)
    figures = {f"results/figures/{file.name}" for file in (finished.path / "results/figures").glob("*.svg")}
    assert len(figures) > 20
    assert figures <= set(needed.split(", "))
    edit_module(finished, "figures/scene")
    assert "rule write_provenance:" in finished.run("-n", "all").text


@pytest.mark.parametrize("name", ["steep", "fig10_slips"])
def test_four_lines_make_a_new_scene_of_any_name(finished, name):
    add(finished, STEEP.replace("steep", name))
    assert finished.would_run() == of(name) | LISTS_OF_SCENES


def test_an_edit_of_a_scene_runs_that_scene_only(more_scenes):
    more_scenes.edit("config.yaml", 'leading edge\n    theta: "9/10"', 'leading edge\n    theta: "8/10"')
    assert more_scenes.would_run() == of("steep") | LISTS_OF_SCENES


def test_another_model_asks_that_scene_again_and_nothing_else(more_scenes):
    more_scenes.edit("config.yaml", "model: law", "model: rigid")
    assert more_scenes.would_run() - PAPER == {"answer_scene quick"}


def test_a_new_title_simulates_nothing(finished):
    finished.edit("config.yaml", "title: uniform normal loading", "title: same load on every block")
    assert finished.would_run() == {"draw_scene fig10", "write_explorer"} | PAPER


def test_a_new_number_of_the_paper_simulates_nothing(finished):
    finished.edit("config.yaml", "events_kept: 9", "events_kept: 8")
    of_definitions = {"tabulate_definitions", "draw_definitions", "tabulate_random_steps"}
    assert finished.would_run() == {"tabulate_reproduction", "evaluate_claims"} | of_definitions | PAPER


def test_longer_chains_of_the_scenes_leave_the_comparison_of_methods_as_it_is(finished):
    finished.edit("config.yaml", "n_blocks: 10\n  mu_s", "n_blocks: 20\n  mu_s")
    jobs = finished.would_run()
    assert "simulate_scene fig10" in jobs
    assert not {"measure_methods", "measure_cost_per_event"} & jobs


@pytest.mark.parametrize(
    ("module", "jobs"),
    [
        ("figures/scene", {f"draw_scene {scene}" for scene in PAPERS}),
        ("figures/spread", {"draw_spread"}),
        ("figures/definitions", {"draw_definitions"}),
    ],
)
def test_an_edit_of_a_figure_module_draws_its_figures_again_and_nothing_else(finished, module, jobs):
    edit_module(finished, module)
    assert finished.would_run() - PAPER == jobs


def test_an_edit_of_the_style_draws_all_figures_and_computes_nothing(finished):
    edit_module(finished, "figures/style")
    jobs = finished.would_run()
    assert {"draw_fig13", "draw_horizon", "draw_scene fig10"} <= jobs
    assert {job for job in jobs if not job.startswith("draw_")} <= {"write_explorer"} | PAPER


def test_an_edit_of_the_solver_simulates_again(finished):
    edit_module(finished, "solver/kernel/events")
    reasons = finished.run("-n", "all").reasons
    assert all(
        reasons[f"simulate_scene {scene}"] == {"src/precursors/solver/kernel/events.py"} for scene in PAPERS
    )


def test_an_edit_of_a_method_measures_again_and_simulates_nothing(finished):
    edit_module(finished, "methods/moreau_jean")
    jobs = finished.would_run()
    assert {"measure_methods", "draw_work_precision"} <= jobs
    assert not ({"take_certificates", "measure_cost_per_event", "run_chunk"} | of(*PAPERS)) & jobs


def test_an_edit_of_a_script_runs_its_rule_again(finished):
    finished.append("workflow/scripts/tabulate_mu_sapp.py", "\n# edited\n")
    jobs = finished.would_run()
    assert "tabulate_mu_sapp" in jobs
    assert not of(*PAPERS) & jobs


def test_an_edit_of_how_jobs_are_logged_or_files_are_written_runs_nothing(finished):
    finished.append("workflow/scripts/job.py", "\nCHANGED = True\n")
    edit_module(finished, "support/timing")
    assert finished.would_run() == set()


def test_an_edit_of_the_text_sets_the_paper_again_and_nothing_else(finished):
    finished.append("paper/sections/limits.typ", "\nOne sentence more.\n")
    assert finished.would_run() == PAPER


def test_an_edit_of_a_claim_compares_again_and_computes_nothing_else(finished):
    edit_module(finished, "reproduction/claims_results")
    assert finished.would_run() == {"evaluate_claims"} | PAPER


def test_the_full_comparison_of_methods_is_a_target_of_its_own(untouched):
    workspace, _ = untouched
    jobs = workspace.run("-n", "accuracy_full").jobs
    assert {"measure_methods", "draw_work_precision", "tabulate_step_sweep", "draw_step_sweep"} <= jobs
    assert not {"simulate_scene fig10", "run_chunk"} & jobs


def test_a_configuration_without_the_papers_scenes_has_no_claims_and_no_paper(workspace):
    workspace.edit("config.yaml", "  fig12:\n    title", "  mine:\n    title")
    workspace.edit("config.yaml", "fig13: [fig11, fig10, fig12]", "fig13: [fig11, fig10, mine]")
    jobs = workspace.would_run()
    assert "tabulate_definitions" in jobs
    assert not {"evaluate_claims", "write_paper"} & jobs


@pytest.mark.parametrize("model", ["quasistatic", "chain"])
def test_a_scene_that_names_a_model_is_answered_and_not_run(finished, model):
    add(finished, ASKED.format(model=model))
    assert finished.would_run() - PAPER == {"answer_scene quick"}
    assert "MissingRuleException" in finished.run("-n", "results/runs/quick.h5").text


def test_the_answer_of_a_model_is_computed(compiled_workspace):
    add(compiled_workspace, ASKED.format(model="chain"))
    outcome = compiled_workspace.run("-c1", "results/tables/quick_answers.csv")
    assert outcome.code == 0, outcome.text
    answers = pd.read_csv(compiled_workspace.path / "results/tables/quick_answers.csv")
    expected = answers_table(Chain.from_slider(theta="9/10"), "chain", {}).reset_index(drop=True)
    pd.testing.assert_frame_equal(answers, expected, check_dtype=False)
