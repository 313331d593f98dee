"""What is run: every job once, and after an edit only what the edit touches."""

import re
import shutil

import pandas as pd
import pytest
from conftest import ROOT, copy_workflow

from precursors.hierarchy.models import scene_answers

PAPERS = ("fig10", "fig11", "fig12")
# Rules that `all` leaves out, and write_provenance, which conftest leaves out of all lists of jobs.
ON_DEMAND = {
    "certify_scene",
    "prove_again",
    "write_provenance",
}
# The paper shows nearly all tables and figures, and is set again when one of them may change.
PAPER = {"write_paper"}
LISTS_OF_SCENES = {
    "tabulate_reproduction",
    "tabulate_claims",
    "draw_reproduction",
    "write_explorer",
} | PAPER
CODE = "\nADDED = 1\n"  # to a module
# A name that looks like that of a table.
SCENE = """\
  fig10_slips:
    title: nearly all of the load at the leading edge
    theta: "9/10"
    duration: 1.0
"""
ASKED = """\
  asked:
    title: what the chain says
    theta: "9/10"
    model: chain
"""


def of(*scenes):
    """The jobs of some scenes."""
    return {f"simulate_scene {scene}" for scene in scenes}


def add(workspace, scene):
    workspace.edit("config.yaml", "\nfig13: [", f"{scene}\nfig13: [")


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
    assert rules - {"simulate_scene"} - ON_DEMAND <= outcome.jobs
    assert of(*PAPERS) <= outcome.jobs
    assert not ON_DEMAND & outcome.jobs
    assert not (workspace.path / "results").exists()


def test_a_second_run_has_nothing_to_do(finished):
    before = finished.results()
    outcome = finished.run("-c2", "all")
    assert outcome.code == 0
    assert "Nothing to be done" in outcome.text
    assert finished.results() == before


def test_the_provenance_comes_after_all_figures(untouched):
    (needed,) = [inputs for job, inputs, _ in untouched[1].plan if job == "write_provenance"]
    made = set().union(*(outputs for _, _, outputs in untouched[1].plan))
    figures = {file for file in made if file.startswith("results/figures/") and file.endswith(".svg")}
    assert len(figures) > 10
    assert figures <= needed


# What an edit runs again


def test_words_format_and_touch_run_nothing_again(finished):
    for file in [*finished.path.glob("src/**/*.py"), *finished.path.glob("workflow/scripts/*.py")]:
        text = file.read_text(encoding="utf-8").replace('"""', '"""Other words. ', 1)
        file.write_text(f"{text}\n\n# more words\n", encoding="utf-8")
    finished.append("config.yaml", "# more words\n")
    assert finished.would_run() == set()


def test_results_copied_into_a_fresh_clone_are_up_to_date_and_an_edit_is_seen(finished, tmp_path):
    clone = copy_workflow(tmp_path / "clone")
    shutil.copy(finished.path / "config.yaml", clone.path)
    for name in ("results", ".snakemake/metadata"):
        shutil.copytree(finished.path / name, clone.path / name, copy_function=shutil.copyfile)
    assert clone.would_run() == set()
    clone.append("src/precursors/figures/theta_window.py", CODE)
    assert clone.would_run() == {"draw_ensembles"} | PAPER


@pytest.mark.parametrize(
    ("module", "run", "left"),
    [
        ("figures/scene", {"draw_reproduction"}, {"tabulate", "simulate", "draw_accuracy"}),
        ("figures/style", {"draw_reproduction", "draw_accuracy"}, {"tabulate", "simulate"}),
        (
            "methods/moreau_jean",
            {"tabulate_work_precision", "draw_accuracy"},
            {"take", "run_chunk", "simulate"},
        ),
        ("analysis/slips", {"simulate_scene fig10", "tabulate_reproduction"}, {"take_certificates"}),
        ("solver/kernel/events", of(*PAPERS) | {"run_chunk"}, set()),
    ],
)
def test_an_edit_of_a_module_runs_what_computes_with_it_and_nothing_else(finished, module, run, left):
    finished.append(f"src/precursors/{module}.py", CODE)
    jobs = finished.would_run()
    assert run <= jobs
    assert not [job for job in jobs if job.startswith(tuple(left))]


def test_an_edit_of_the_paper_sets_it_again(finished):
    finished.append("paper/paper.typ", "\n// edited\n")
    assert finished.would_run() == PAPER


# What an edit of the configuration runs again


def test_four_lines_make_a_new_scene_of_any_name(finished):
    add(finished, SCENE)
    assert finished.would_run() == of("fig10_slips") | LISTS_OF_SCENES


def test_an_edit_of_a_scene_runs_that_scene_only_and_another_model_answers_its_own(finished):
    finished.edit("config.yaml", 'leading edge\n    theta: "9/10"', 'leading edge\n    theta: "8/10"')
    finished.edit("config.yaml", "model: law", "model: rigid")
    assert finished.would_run() == of("steep") | LISTS_OF_SCENES | {"tabulate_quick_answers"}
    assert "MissingRuleException" in finished.run("-n", "results/runs/quick.h5").text


@pytest.mark.parametrize(
    ("old", "new", "jobs"),
    [
        ("title: uniform normal loading", "title: the same load", {"draw_reproduction", "write_explorer"}),
        ("figure: {}", "figure: {width_mm: 85, font_size: 9}", {"draw_reproduction"}),
    ],
)
def test_another_title_or_look_simulates_nothing(finished, old, new, jobs):
    finished.edit("config.yaml", old, new)
    assert finished.would_run() - PAPER == jobs


def test_longer_chains_of_the_scenes_leave_the_comparison_of_methods_as_it_is(finished):
    finished.edit("config.yaml", "n_blocks: 10\n  mu_s", "n_blocks: 20\n  mu_s")
    jobs = finished.would_run()
    assert "simulate_scene fig10" in jobs
    assert "tabulate_work_precision" not in jobs


def test_larger_studies_are_an_overlay_of_the_configuration(finished):
    outcome = finished.run("-n", "--configfile", "config.yaml", "workflow/full.yaml", "--", "all")
    assert outcome.code == 0, outcome.text
    assert {"tabulate_work_precision", "tabulate_step_sweep", "tabulate_predictability"} <= outcome.jobs
    assert not {"simulate_scene fig10", "tabulate_definitions"} & outcome.jobs


def test_a_configuration_without_the_papers_scenes_has_no_claims_and_no_paper(workspace):
    workspace.edit("config.yaml", "  fig12:\n    title", "  mine:\n    title")
    workspace.edit("config.yaml", "fig13: [fig11, fig10, fig12]", "fig13: [fig11, fig10, mine]")
    jobs = workspace.would_run()
    assert "tabulate_definitions" in jobs
    assert not {"tabulate_claims", "write_paper"} & jobs


def test_the_answer_of_a_model_is_computed(workspace):
    add(workspace, ASKED)
    outcome = workspace.run("-c1", "results/tables/asked_answers.csv")
    assert outcome.code == 0, outcome.text
    answers = pd.read_csv(workspace.path / "results/tables/asked_answers.csv")
    expected = scene_answers({"theta": "9/10"}, "chain").reset_index(drop=True)
    pd.testing.assert_frame_equal(answers, expected, check_dtype=False)
