"""What is run: every job once, and after an edit only what the edit touches."""

import re
import shutil
from pathlib import Path

import pandas as pd
import pytest
from conftest import ROOT, Workspace

from precursors import Chain
from precursors.hierarchy.models import answers_table

SCENE_JOBS = {"simulate_scene", "tabulate_slips", "tabulate_trace", "draw_scene"}
# Rules that `all` leaves out.
ON_DEMAND = {
    "accuracy_full",
    "answer_scene",
    "certify_scene",
    "prove_again",
    "prove_scenes",
    "write_provenance",  # part of `all`, but in no list of jobs here
}
RULES = {
    rule
    for file in (ROOT / "workflow/rules").glob("*.smk")
    for rule in re.findall(r"^rule (\w+):", file.read_text(encoding="utf-8"), flags=re.MULTILINE)
}
SHARED_JOBS = RULES - SCENE_JOBS - ON_DEMAND
# The paper shows nearly all tables and figures, and is set again when one of them may change.
PAPER = {"write_paper"}
LISTS_OF_SCENES = {"tabulate_mu_sapp", "tabulate_reproduction", "evaluate_claims", "write_explorer"} | PAPER
PAPERS = ("fig10", "fig11", "fig12")
NEW_SCENE = """\
  steep:
    title: nearly all of the load at the leading edge
    theta: "9/10"
    duration: 1.0
"""
ASKED_SCENE = """\
  quick:
    title: what a smaller model says
    theta: "9/10"
    model: {model}
"""
SOFT_SCENE = """\
  soft:
    title: an interface with springs and viscosity
    theta: "9/10"
    model: interface
    interface_stiffness: 25.0e+6
    viscosity: 54.77
"""


def of(scene):
    return {f"{job} {scene}" for job in SCENE_JOBS}


@pytest.fixture(scope="module")
def _more_scenes(_finished, tmp_path_factory):
    workspace = Workspace(tmp_path_factory.mktemp("more_scenes") / "copy")
    shutil.copytree(_finished.path, workspace.path)
    add(workspace, NEW_SCENE + SOFT_SCENE + ASKED_SCENE.format(model="chain"))
    outcome = workspace.pretend("-c2", "all")
    assert outcome.code == 0, outcome.text
    return workspace


@pytest.fixture
def more_scenes(_more_scenes, tmp_path):
    """As `finished`, with a scene more of every kind that was run to the end as well."""
    shutil.copytree(_more_scenes.path, tmp_path / "copy")
    return Workspace(tmp_path / "copy")


def add(workspace, scene):
    workspace.edit("config.yaml", "\nfig13: [", f"{scene}\nfig13: [")


def test_a_dry_run_lists_every_job_of_the_paper(untouched):
    _, outcome = untouched
    assert outcome.code == 0, outcome.text
    assert outcome.jobs == of("fig10") | of("fig11") | of("fig12") | SHARED_JOBS


def test_a_dry_run_writes_nothing(untouched):
    workspace, _ = untouched
    assert not (workspace.path / "results").exists()


def test_a_single_figure_needs_its_own_jobs_only(untouched):
    workspace, _ = untouched
    outcome = workspace.run("-n", "results/figures/fig13.svg")
    assert outcome.jobs == {f"{job} {s}" for job in ("simulate_scene", "tabulate_slips") for s in PAPERS} | {
        "draw_fig13"
    }


def test_a_second_run_has_nothing_to_do(finished):
    before = finished.results()
    outcome = finished.run("-c2", "all")
    assert outcome.code == 0
    assert "Nothing to be done" in outcome.text
    assert finished.results() == before


def test_four_lines_make_a_new_scene(finished):
    add(finished, NEW_SCENE)
    assert finished.would_run() == of("steep") | LISTS_OF_SCENES


def test_a_scene_may_have_any_name_that_is_a_word(finished):
    add(finished, NEW_SCENE.replace("steep", "fig10_slips"))
    assert finished.would_run() == of("fig10_slips") | LISTS_OF_SCENES


def test_an_edit_of_a_figure_module_redraws_its_figures_only(finished):
    """All are edited at once, and each job must name the modules for which it is run."""
    redrawn = {
        "chain_schematic": {"draw_fig09"},
        "scene": {"draw_scene fig10", "draw_scene fig11", "draw_scene fig12"},
        "precursor_lengths": {"draw_fig13"},
        "definitions": {"draw_definitions"},
        "spread": {"draw_spread"},
        "map_of": {"draw_map"},
    }
    for module in redrawn:
        finished.append(f"src/precursors/figures/{module}.py", "\nCOLOR = 'red'\n")
    reasons = finished.run("-n", "all").reasons
    assert reasons == {
        job: {f"src/precursors/figures/{module}.py"} for module, jobs in redrawn.items() for job in jobs
    } | {"write_paper": reasons["write_paper"]}
    # Not the figure of definitions, which the paper does not show.
    shown = {Path(figure).stem.split("_")[0] for figure in reasons["write_paper"]}
    assert shown == {"fig09", *PAPERS, "fig13", "map", "spread"}


def test_an_edit_of_the_style_redraws_all_figures_and_simulates_nothing(finished):
    finished.append("src/precursors/figures/style.py", "\nCOLOR = 'red'\n")
    drawings = {job for job in SHARED_JOBS if job.startswith("draw_")}
    scenes = {f"draw_scene {scene}" for scene in PAPERS}
    assert finished.would_run() == drawings | scenes | {"write_explorer"} | PAPER


def test_an_edit_of_the_solver_simulates_again(finished):
    """All are edited at once, and each job must name every module."""
    modules = {
        f"src/precursors/{module}.py" for module in ("chain", "exact", "kernel/watch", "kernel/lanes", "run")
    }
    for module in modules:
        finished.append(module, "\nCHANGED = True\n")
    reasons = finished.run("-n", "all").reasons
    assert all(reasons[f"simulate_scene {scene}"] == modules for scene in PAPERS)


def test_an_edit_of_the_estimate_of_errors_simulates_and_proves_nothing(finished):
    finished.append("src/precursors/horizon.py", "\nCHANGED = True\n")
    assert finished.would_run() == {"tabulate_horizon", "draw_horizon"} | PAPER


def test_an_edit_of_how_proof_and_run_are_compared_proves_and_simulates_nothing(finished):
    finished.append("src/precursors/accuracy/compare.py", "\nCHANGED = True\n")
    assert finished.would_run() == {"tabulate_horizon", "draw_horizon"} | PAPER


def test_an_edit_of_how_tables_are_written_makes_all_of_them_again(finished):
    finished.append("src/precursors/table_files.py", "\nCHANGED = True\n")
    jobs = finished.would_run()
    assert {job for job in SHARED_JOBS if job.startswith("tabulate_")} <= jobs
    assert not {f"simulate_scene {scene}" for scene in PAPERS} & jobs
    assert not {"run_chunk", "take_certificates"} & jobs


def test_an_edit_of_how_jobs_are_logged_runs_nothing(finished):
    finished.append("workflow/scripts/job.py", "\nCHANGED = True\n")
    finished.append("src/precursors/progress.py", "\nCHANGED = True\n")
    assert finished.would_run() == set()


def test_an_edit_of_a_script_runs_its_rule_again(finished):
    finished.append("workflow/scripts/judge_claims.py", "\n# edited\n")
    assert finished.would_run() == {"judge_claims"} | PAPER


def test_an_edit_of_a_scene_runs_that_scene_only(more_scenes):
    more_scenes.edit("config.yaml", 'leading edge\n    theta: "9/10"', 'leading edge\n    theta: "8/10"')
    assert more_scenes.would_run() == of("steep") | LISTS_OF_SCENES


def test_a_new_title_simulates_nothing(finished):
    finished.edit("config.yaml", "title: uniform normal loading", "title: same load on every block")
    assert finished.would_run() == {"draw_scene fig10", "write_explorer"} | PAPER


def test_a_new_number_of_the_paper_simulates_nothing(finished):
    finished.edit("config.yaml", "events_kept: 9", "events_kept: 8")
    of_definitions = {"tabulate_definitions", "draw_definitions"}
    assert finished.would_run() == {"tabulate_reproduction", "evaluate_claims"} | of_definitions | PAPER


def test_the_full_comparison_of_methods_is_a_target_of_its_own(workspace):
    assert workspace.run("-n", "accuracy_full").jobs == {
        "take_certificates",
        "measure_methods_fully",
        "draw_work_precision",
        "draw_work_precision_evaluations",
        "tabulate_step_sweep",
        "draw_step_sweep",
        "accuracy_full",
    }


def test_an_edit_of_a_method_measures_again_and_proves_nothing(finished):
    finished.append("src/precursors/integrators/moreau_jean.py", "\nCHANGED = True\n")
    jobs = finished.would_run()
    assert {"measure_methods", "draw_work_precision"} <= jobs
    assert not {"take_certificates", "measure_growth", "measure_methods_fully"} & jobs


def test_an_edit_of_a_chart_measures_nothing(finished):
    finished.append("src/precursors/figures/cost_per_event.py", "\nCOLOR = 'red'\n")
    finished.append("src/precursors/figures/work_precision.py", "\nCOLOR = 'red'\n")
    assert (
        finished.would_run()
        == {"draw_cost_per_event", "draw_work_precision", "draw_work_precision_evaluations"} | PAPER
    )


def test_longer_chains_of_the_scenes_leave_the_comparison_of_methods_as_it_is(finished):
    finished.edit("config.yaml", "n_blocks: 10\n  mu_s", "n_blocks: 20\n  mu_s")
    jobs = finished.would_run()
    assert "simulate_scene fig10" in jobs
    assert not {"measure_methods", "measure_growth"} & jobs


def test_an_edit_of_a_claim_compares_again_and_computes_nothing_else(finished):
    finished.append("src/precursors/reproduction/claims_results.py", "\nCHANGED = True\n")
    assert finished.would_run() == {"evaluate_claims"} | PAPER


def test_a_configuration_without_the_papers_scenes_has_no_claims_and_no_paper(workspace):
    workspace.edit("config.yaml", "  fig12:\n    title", "  mine:\n    title")
    workspace.edit("config.yaml", "fig13: [fig11, fig10, fig12]", "fig13: [fig11, fig10, mine]")
    jobs = workspace.would_run()
    assert "tabulate_definitions" in jobs
    assert not {"evaluate_claims", "write_paper"} & jobs


def test_a_scene_of_the_paper_given_by_theta_leaves_out_the_paper_and_runs(workspace):
    workspace.edit("config.yaml", "    load_cell_a: 200.0\n    load_cell_b: 200.0\n", "    theta: 0\n")
    jobs = workspace.would_run()
    assert "simulate_scene fig10" in jobs
    assert "write_paper" not in jobs


def test_an_edit_of_the_text_sets_the_paper_again_and_nothing_else(finished):
    finished.append("paper/sections/limits.typ", "\nOne sentence more.\n")
    assert finished.would_run() == PAPER


@pytest.mark.parametrize("model", ["quasistatic", "chain"])
def test_a_scene_that_names_a_model_is_answered_and_has_no_run(finished, model):
    add(finished, ASKED_SCENE.format(model=model))
    assert finished.would_run() == {"answer_scene quick"}
    outcome = finished.run("-n", "results/runs/quick.h5")
    assert outcome.code != 0
    assert "MissingRuleException" in outcome.text


def test_a_new_value_of_an_addition_asks_that_scene_only(finished):
    add(finished, ASKED_SCENE.format(model="law") + SOFT_SCENE)
    assert finished.would_run() == {"answer_scene quick", "answer_scene soft"}


def test_scenes_with_models_are_computed(compiled_workspace):
    workspace = compiled_workspace
    add(workspace, ASKED_SCENE.format(model="chain") + SOFT_SCENE)
    outcome = workspace.run("-c1", "results/tables/quick_answers.csv", "results/tables/soft_answers.csv")
    assert outcome.code == 0, outcome.text
    results = workspace.path / "results"
    quick, soft = (pd.read_csv(results / f"tables/{scene}_answers.csv") for scene in ("quick", "soft"))
    chain = Chain.from_slider(theta="9/10")
    pd.testing.assert_frame_equal(quick, answers_table(chain, "chain"), check_dtype=False)
    additions = {"interface_stiffness": 25e6, "viscosity": 54.77}
    pd.testing.assert_frame_equal(soft, answers_table(chain, "interface", additions), check_dtype=False)
    assert not (results / "runs").exists()
