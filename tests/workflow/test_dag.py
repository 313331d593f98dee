"""What is run: every job once, and after an edit only what the edit touches."""

import pytest

SCENE_JOBS = {"simulate_scene", "tabulate_slips", "tabulate_trace", "draw_scene"}
SHARED_JOBS = {"tabulate_mu_sapp", "tabulate_reproduction", "check_eq15", "draw_chain", "draw_fig13"}
PAPERS = ("fig10", "fig11", "fig12")
NEW_SCENE = """\
  steep:
    title: nearly all of the load at the leading edge
    theta: "9/10"
    duration: 1.0
"""


def of(scene):
    return {f"{job} {scene}" for job in SCENE_JOBS}


def add_scene(workspace):
    workspace.edit("config.yaml", "\nfig13: [", f"{NEW_SCENE}\nfig13: [")


def test_a_dry_run_lists_every_job_of_the_paper(workspace):
    assert workspace.would_run() == of("fig10") | of("fig11") | of("fig12") | SHARED_JOBS


def test_a_dry_run_writes_nothing(workspace):
    workspace.would_run()
    assert not (workspace.path / "results").exists()


def test_a_single_figure_needs_its_own_jobs_only(workspace):
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
    add_scene(finished)
    assert finished.would_run() == of("steep") | {"tabulate_mu_sapp", "tabulate_reproduction"}


def test_a_scene_may_have_any_name_that_is_a_word(finished):
    finished.edit("config.yaml", "\nfig13: [", f"{NEW_SCENE.replace('steep', 'fig10_slips')}\nfig13: [")
    assert finished.would_run() == of("fig10_slips") | {"tabulate_mu_sapp", "tabulate_reproduction"}


@pytest.mark.parametrize(
    ("module", "redrawn"),
    [
        ("chain_schematic", {"draw_chain"}),
        ("scene", {"draw_scene fig10", "draw_scene fig11", "draw_scene fig12"}),
        ("precursor_lengths", {"draw_fig13"}),
    ],
)
def test_an_edit_of_a_figure_module_redraws_its_figures_only(finished, module, redrawn):
    finished.append(f"src/precursors/figures/{module}.py", "\nCOLOR = 'red'\n")
    assert finished.would_run() == redrawn


def test_an_edit_of_the_style_redraws_all_figures_and_simulates_nothing(finished):
    finished.append("src/precursors/figures/style.py", "\nCOLOR = 'red'\n")
    assert finished.would_run() == {"draw_chain", "draw_fig13"} | {f"draw_scene {scene}" for scene in PAPERS}


@pytest.mark.parametrize("module", ["chain", "exact", "kernel", "run"])
def test_an_edit_of_the_solver_simulates_again(finished, module):
    finished.append(f"src/precursors/{module}.py", "\nCHANGED = True\n")
    assert {f"simulate_scene {scene}" for scene in PAPERS} <= finished.would_run()


def test_an_edit_of_a_script_runs_its_rule_again(finished):
    finished.append("workflow/scripts/draw_fig13.py", "\n# edited\n")
    assert finished.would_run() == {"draw_fig13"}


def test_an_edit_of_a_scene_runs_that_scene_only(finished):
    add_scene(finished)
    finished.run("-c2", "all")
    finished.edit("config.yaml", 'theta: "9/10"', 'theta: "8/10"')
    assert finished.would_run() == of("steep") | {"tabulate_mu_sapp", "tabulate_reproduction"}


def test_a_new_title_simulates_nothing(finished):
    finished.edit("config.yaml", "title: uniform normal loading", "title: same load on every block")
    assert finished.would_run() == {"draw_scene fig10"}


def test_a_new_number_of_the_paper_simulates_nothing(finished):
    finished.edit("config.yaml", "events_kept: 9", "events_kept: 8")
    assert finished.would_run() == {"tabulate_reproduction"}
